"""What one core can do at most with vectors of sixteen float32: sums of products, and loads from its nearest cache.

Both loops keep enough independent chains in flight to hide every latency, and do nothing else.
"""

from __future__ import annotations

from numba import njit
from numba.extending import overload

from synth.kernels.vector.numba_internals import declared_function, intrinsic
from synth.kernels.vector.pack_code import suffix
from synth.kernels.vector.packs import SIXTEEN, load16, store


def multiply_add(a, b, c):
    """a·b + c lane by lane."""
    return a * b + c


@intrinsic
def rounded_once(typing, a, b, c):
    """a·b + c lane by lane, in one instruction where the processor can."""

    def code(context, builder, sig, args):
        kind = args[0].type
        called = declared_function(builder, f"llvm.fmuladd.{suffix(a.element, a.lanes)}", kind, [kind] * 3)
        return builder.call(called, args)

    return a(a, b, c), code


overload(multiply_add)(lambda a, b, c: lambda a, b, c: rounded_once(a, b, c))


@njit(cache=True, error_model="numpy")
def multiply_adds(turns, factor, result):
    """`turns` × 12 products summed in registers; `factor`, `result` (16,)."""
    f = load16(factor, 0)
    # The chains begin with different numbers: the compiler would make one of equal ones.
    a, b, c, d = f + 0.1, f + 0.2, f + 0.3, f + 0.4
    e, g, h, i = f + 0.5, f + 0.6, f + 0.7, f + 0.8
    j, k, m, n = f + 0.9, f + 1.0, f + 1.1, f + 1.2
    for _ in range(turns):
        a, b, c = multiply_add(a, f, f), multiply_add(b, f, f), multiply_add(c, f, f)
        d, e, g = multiply_add(d, f, f), multiply_add(e, f, f), multiply_add(g, f, f)
        h, i, j = multiply_add(h, f, f), multiply_add(i, f, f), multiply_add(j, f, f)
        k, m, n = multiply_add(k, f, f), multiply_add(m, f, f), multiply_add(n, f, f)
    store(result, 0, ((a + b) + (c + d)) + ((e + g) + (h + i)) + ((j + k) + (m + n)))


@njit(cache=True, error_model="numpy")
def loads_a_turn(floats):
    """How many loads one turn of `loads` makes in so many floats: whole rounds of its eight chains."""
    return (floats - SIXTEEN) // (8 * SIXTEEN) * 8


@njit(cache=True, error_model="numpy")
def loads(turns, data, result):
    """`turns` × `loads_a_turn` loads through all of `data` float32, summed up in `result` (16,).

    The place changes with the turn, or LLVM would keep copies of all that is loaded.
    """
    length = loads_a_turn(data.shape[0]) * SIXTEEN
    nothing = load16(data, 0) - load16(data, 0)
    a, b, c, d = nothing, nothing, nothing, nothing
    e, f, g, h = nothing, nothing, nothing, nothing
    for turn in range(turns):
        begin = turn % 2 * SIXTEEN
        for at in range(begin, begin + length, 8 * SIXTEEN):
            a = a + load16(data, at)
            b = b + load16(data, at + 1 * SIXTEEN)
            c = c + load16(data, at + 2 * SIXTEEN)
            d = d + load16(data, at + 3 * SIXTEEN)
            e = e + load16(data, at + 4 * SIXTEEN)
            f = f + load16(data, at + 5 * SIXTEEN)
            g = g + load16(data, at + 6 * SIXTEEN)
            h = h + load16(data, at + 7 * SIXTEEN)
    store(result, 0, ((a + b) + (c + d)) + ((e + f) + (g + h)))
