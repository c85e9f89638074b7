"""Kernels of the dynamic programme, and of the exact evaluation of a policy."""
