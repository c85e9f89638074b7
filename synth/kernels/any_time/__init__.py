"""Kernels of regulators that may give a command at every sample, also during a change of stage."""
