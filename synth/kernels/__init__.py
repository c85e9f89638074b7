"""The inner loops, compiled.

Importing any of them first points numba at the cache of exactly these sources.
"""

from synth.kernels.cache import use_kernel_cache

use_kernel_cache()
