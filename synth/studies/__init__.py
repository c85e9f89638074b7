"""The laboratory: what the machine was measured with. No command but `study` reaches it."""
