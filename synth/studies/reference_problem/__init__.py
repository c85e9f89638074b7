"""The neutral reference problem by which the speed of the kernels is compared with other software.

Not part of a tune: `scripts/benchmark` and the tests use it. `docs/benchmark.md` tells what was measured.
"""
