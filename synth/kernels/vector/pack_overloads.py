"""How the functions of `packs` are compiled: as vectors of the processor."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from numba.extending import overload

from synth.kernels.vector import mask_code, pack_code, pack_memory
from synth.kernels.vector.numba_internals import WITHOUT_CALLBACK

CODE: Mapping[str, Callable[..., Any]] = {
    "item": lambda array, at: lambda array, at: pack_memory.item(array, at),
    "add_to": lambda array, at, number: lambda array, at, number: pack_memory.add_to(array, at, number),
    "fetch": lambda array, at: lambda array, at: pack_memory.fetch(array, at),
    "eight": lambda number: lambda number: pack_code.eight(number),
    "load16": lambda array, at: lambda array, at: pack_memory.load16(array, at),
    "load8": lambda array, at: lambda array, at: pack_memory.load8(array, at),
    "store": lambda array, at, pack: lambda array, at, pack: pack_memory.store(array, at, pack),
    "gather": lambda array, where: lambda array, where: pack_memory.gather(array, where),
    "gather_four": lambda array, where: lambda array, where: pack_memory.gather_four(array, where),
    "choose": lambda mask, yes, no: lambda mask, yes, no: pack_code.choose(mask, yes, no),
    "least": lambda a, b: lambda a, b: pack_code.choose(b < a, b, a),
    "greatest": lambda a, b: lambda a, b: pack_code.choose(b > a, b, a),
    "magnitude": lambda pack: lambda pack: pack_code.choose(pack < 0.0, pack * -1.0, pack),
    "holds_anywhere": lambda mask: lambda mask: pack_code.holds_anywhere(mask),
    "whole": lambda pack: lambda pack: pack_code.whole(pack),
    "fraction": lambda pack: lambda pack: pack_code.fraction(pack),
    "scatter": lambda array, where, mask, pack: (
        lambda array, where, mask, pack: pack_memory.scatter(array, where, mask, pack)
    ),
    "keep": lambda array, at, mask, pack: lambda array, at, mask, pack: pack_memory.keep(array, at, mask, pack),
    "opposite": lambda mask: lambda mask: pack_code.opposite(mask),
    "narrow": lambda pack: lambda pack: pack_code.narrow(pack),
    "wide": lambda pack: lambda pack: pack_code.wide(pack),
    "root": lambda pack: lambda pack: pack_code.root(pack),
    "nearest": lambda pack: lambda pack: pack_code.nearest(pack),
    "first_lane": lambda mask: lambda mask: mask_code.first_lane(mask),
    "last_lane": lambda mask, count: lambda mask, count: mask_code.last_lane(mask, count),
}
"""By name of the function, what numba asks for: the code for these types of arguments."""


def overload_all(definitions: Mapping[str, Callable[..., Any]]) -> None:
    """Have numba compile each of the `definitions` by the code of its name."""
    overloaded: Any = partial(overload, jit_options=WITHOUT_CALLBACK)
    for name, definition in definitions.items():
        overloaded(definition)(CODE[name])
