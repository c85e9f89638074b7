"""Kernels of measured passes: what the valves did, and how well motion and gauge agree with it."""
