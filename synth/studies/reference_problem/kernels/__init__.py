"""Kernels of the neutral problem that other programs solve too."""
