"""How kernels are compiled: decorators with all options, for kernels that make arrays and those that borrow them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from numba import njit

from synth.kernels.vector.numba_internals import (
    IN_ITS_CALLERS,
    WITHOUT_CALLBACK,
    WITHOUT_REFERENCE_COUNTS,
    compiled_part,
)

KEPT: Final[dict[str, Any]] = {"cache": True, "nogil": True, **WITHOUT_CALLBACK}
BARE: Final[dict[str, Any]] = {**KEPT, "error_model": "numpy"}

# numba counts references to every array that it passes on or takes from a tuple, each time by an atomic operation; in
# the closed loop that took a third of the time. A kernel that makes no array does not need it.
BORROWED: Final[dict[str, Any]] = {**BARE, **WITHOUT_REFERENCE_COUNTS}

kernel: Final[Any] = njit(**BARE)
"""A kernel that may make arrays; a division by 0 gives what it does in numpy."""

kernel_inline: Final[Any] = njit(**BARE, inline="always")
"""Part of the kernels that call it, put there before types are found."""

raising: Final[Any] = njit(**KEPT)
"""A kernel in which a division by 0 raises, as in Python."""

borrowing: Final[Any] = njit(**BORROWED)
"""A kernel that only borrows memory: it neither makes an array nor keeps one."""

borrowing_inline: Final[Any] = njit(**BORROWED, **IN_ITS_CALLERS)
"""The same, put into the kernels that call it."""


def part(function: Callable[..., Any]) -> Any:
    """A kernel that borrows memory, and that kernels alone call: from Python there is its `py_func`."""
    return compiled_part(function, BORROWED)


def part_inline(function: Callable[..., Any]) -> Any:
    """The same, put into the kernels that call it."""
    return compiled_part(function, {**BORROWED, **IN_ITS_CALLERS})
