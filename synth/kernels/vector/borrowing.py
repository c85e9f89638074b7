"""Decorators of kernels that only borrow memory: they neither make an array nor keep one."""

from __future__ import annotations

from typing import Any

from numba import njit

from synth.kernels.vector.numba_internals import WITHOUT_REFERENCE_COUNTS

# numba counts references to every array that it passes on or takes from a tuple, each time by an atomic operation; in
# the closed loop that took a third of the time. A kernel that makes no array does not need it.
OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy", **WITHOUT_REFERENCE_COUNTS}

borrowing: Any = njit(**OPTIONS)
"""A kernel of its own."""

borrowing_inline: Any = njit(**OPTIONS, forceinline=True)
"""Part of the kernels that call it."""
