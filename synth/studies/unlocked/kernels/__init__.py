"""Kernels of the programme that may give a command at every sample."""
