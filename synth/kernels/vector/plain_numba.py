"""What stands for `numba_internals` where numba's inside is left alone (`kernels.plain`): only what numba promises."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from numba import njit

WITHOUT_REFERENCE_COUNTS: dict[str, Any] = {}
WITHOUT_CALLBACK: dict[str, Any] = {}
IN_ITS_CALLERS: dict[str, Any] = {}


def compiled_part(function: Callable[..., Any], options: Mapping[str, Any]) -> Any:
    """`function` compiled with `options` of `njit`; Python could call it too."""
    compiler: Any = njit
    return compiler(**options)(function)
