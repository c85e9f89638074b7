"""Kernels of the closed-loop simulation."""
