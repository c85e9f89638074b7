"""Tables of regulators that may give a command at every sample."""
