"""Pictures of a control computer."""
