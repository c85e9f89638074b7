"""What one core can do at most with vectors of sixteen float32: sums of products, and loads from its nearest cache.

Both loops keep enough independent chains in flight to hide every latency, and do nothing else.
"""

from __future__ import annotations

from numba import njit

from synth.studies.reference_problem.kernels.vectors import LANES, load, multiply_add, splat, store


@njit(cache=True, nogil=True, error_model="numpy")
def multiply_adds(turns, factor, result):
    """`turns` × 12 products summed in registers; `factor`, `result` (16,)."""
    f = load(factor, 0)
    a, b, c, d = splat(0.1), splat(0.2), splat(0.3), splat(0.4)
    e, g, h, i = splat(0.5), splat(0.6), splat(0.7), splat(0.8)
    j, k, m, n = splat(0.9), splat(1.0), splat(1.1), splat(1.2)
    for _ in range(turns):
        a, b, c = multiply_add(a, f, f), multiply_add(b, f, f), multiply_add(c, f, f)
        d, e, g = multiply_add(d, f, f), multiply_add(e, f, f), multiply_add(g, f, f)
        h, i, j = multiply_add(h, f, f), multiply_add(i, f, f), multiply_add(j, f, f)
        k, m, n = multiply_add(k, f, f), multiply_add(m, f, f), multiply_add(n, f, f)
    store(result, 0, ((a + b) + (c + d)) + ((e + g) + (h + i)) + ((j + k) + (m + n)))


@njit(cache=True, error_model="numpy")
def loads_a_turn(floats, shift):
    """How many loads one turn of `loads` makes in so many floats: whole rounds of its eight chains."""
    return (floats - shift - LANES) // (8 * LANES) * 8


@njit(cache=True, nogil=True, error_model="numpy")
def loads(turns, shift, data, result):
    """`turns` × `loads_a_turn` loads, each `shift` floats off a cache line, through all of `data` float32.

    The place changes with the turn, or LLVM would keep copies of all that is loaded, on cache lines.
    """
    length = loads_a_turn(data.shape[0], shift) * LANES
    a, b, c, d = splat(0.0), splat(0.0), splat(0.0), splat(0.0)
    e, f, g, h = splat(0.0), splat(0.0), splat(0.0), splat(0.0)
    for turn in range(turns):
        begin = shift + turn % 2 * LANES
        for at in range(begin, begin + length, 8 * LANES):
            a = a + load(data, at)
            b = b + load(data, at + 1 * LANES)
            c = c + load(data, at + 2 * LANES)
            d = d + load(data, at + 3 * LANES)
            e = e + load(data, at + 4 * LANES)
            f = f + load(data, at + 5 * LANES)
            g = g + load(data, at + 6 * LANES)
            h = h + load(data, at + 7 * LANES)
    store(result, 0, ((a + b) + (c + d)) + ((e + f) + (g + h)))
