"""For all tests: kernels are compiled for exactly these sources, and hypothesis draws the same examples in CI."""

from __future__ import annotations

import os

from hypothesis import settings

from synth.kernels.cache import use_kernel_cache

# Before any kernel is imported: numba's own cache beside the sources would not notice a change in another file.
use_kernel_cache()

settings.register_profile("ci", derandomize=True, deadline=None)
settings.register_profile("here", deadline=None)
settings.load_profile("ci" if os.environ.get("CI") else "here")
