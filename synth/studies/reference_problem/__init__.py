"""A neutral problem, small and published in full, by which a way of computing is compared with other software.

It is not the tool's problem, and its kernels are its own: what a tune runs is timed by the study `benchmark`.
"""
