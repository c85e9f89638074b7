"""Functions that compute as a command does."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

from synth.kernels.cache import guarded
from synth.solver.descent import one_blas_thread

_P = ParamSpec("_P")
_R = TypeVar("_R")


def as_a_command(call: Callable[_P, _R]) -> Callable[_P, _R]:
    """`call` as a command makes it: with one BLAS thread, and once more where the kernel cache was damaged."""

    @wraps(call)
    def made(*args: _P.args, **kwargs: _P.kwargs) -> _R:
        with one_blas_thread():
            return guarded(call, *args, **kwargs)

    return made
