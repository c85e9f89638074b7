"""Regulators that may give a command at every sample: switching surfaces over path and pressure."""
