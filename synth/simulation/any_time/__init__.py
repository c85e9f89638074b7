"""Simulated passes of regulators that may give a command at every sample."""
