"""Exported tables as control loops: the command, and what it shows."""
