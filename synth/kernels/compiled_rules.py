"""The rules of controllers, compiled unchanged: the loops are driven by what a controller runs.

Numba does not notice that an imported function has changed: the cache directory must be named by a hash that covers
`tuning_tables/programs` too.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from types import FunctionType
from typing import Any

from numba import njit

from synth.kernels.compiling import raising

RULES = "tuning_tables.programs."


@cache
def compiled_rule(rule: Callable[..., Any], fresh: bool = False) -> Any:
    """The rule as numba compiles it, with the rules that it asks.

    `fresh`: for this process alone, without the cache on disk; a division by 0 then gives what it does in numpy.
    """
    found = {name: rule.__globals__.get(name) for name in rule.__code__.co_names}
    asked = {
        name: compiled_rule(each, fresh)
        for name, each in found.items()
        if isinstance(each, FunctionType) and each.__module__.startswith(RULES)
    }
    function = FunctionType(rule.__code__, {**rule.__globals__, **asked}, rule.__name__)
    function.__qualname__ = rule.__qualname__
    return njit(nogil=True, error_model="numpy")(function) if fresh else raising(function)
