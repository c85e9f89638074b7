"""The proof that lower(s) < upper(s) as float32 computes them, by subdivision.

On a piece of the path the exact difference of two lines is written in Bernstein form, in rational arithmetic: it is
nowhere less than its smallest coefficient (Farin, Curves and Surfaces, §5.4). Against it stands a running bound of
what Horner's rule in float32 can be wrong by on that piece (Higham, Accuracy and Stability, §5.1). Where the first is
not larger the piece is halved, until all is proved, or a float32 place is found at which the lines do touch, or too
many pieces are undecided.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Final

from synth.checker.float32 import HALF_ULP, LARGEST, SMALLEST, above, below, horner, rounded

MOST_PIECES: Final = 1000
DOUBLE_ALLOWANCE: Final = 1.0 + 1e-9
"""The running bound is itself computed in double precision."""
SAMPLES: Final = 96


@dataclass(frozen=True)
class Order:
    """How the comparison of two lines ended.

    `proved`: lower < upper on the whole path. Otherwise `touch_m` is a float32 path where lower >= upper as computed,
    or None if none was found: then the lines are too close for a proof, around `closest_m`.
    """

    proved: bool
    touch_m: float | None = None
    closest_m: float = math.nan


def compare(lower: Sequence[float], upper: Sequence[float], path_m: tuple[float, float]) -> Order:
    """Prove or refute the order of two float32 lines of one degree on [s0, s1], both ends float32 numbers."""
    for s in sample_places(path_m):
        if not horner(lower, s) < horner(upper, s):
            return Order(False, s, s)
    difference = [Fraction(b) - Fraction(a) for a, b in zip(lower, upper, strict=True)]
    pieces = [path_m]
    for _ in range(MOST_PIECES):
        if not pieces:
            return Order(True)
        begin, end = pieces.pop()
        error = error_bound(lower, begin, end) + error_bound(upper, begin, end)
        if min(bernstein(difference, begin, end)) > error:
            continue
        middle = rounded(0.5 * (begin + end))
        if not horner(lower, middle) < horner(upper, middle):
            return Order(False, middle, middle)
        if not begin < middle < end:  # neighbours in float32, both of them looked at
            continue
        pieces += [(begin, middle), (middle, end)]
    return Order(not pieces, None, pieces[-1][0] if pieces else math.nan)


def sample_places(path_m: tuple[float, float]) -> Iterator[float]:
    """Float32 places on the path: the ends, their inner neighbours, and an even row between."""
    begin, end = path_m
    yield from (begin, end, above(begin), below(end))
    for i in range(1, SAMPLES):
        yield min(max(rounded(begin + (end - begin) * i / SAMPLES), begin), end)


def bernstein(line: Sequence[Fraction | float], begin: float, end: float) -> list[Fraction]:
    """Coefficients of the polynomial in Bernstein form on [begin, end], exact."""
    a, h, r = Fraction(begin), Fraction(end) - Fraction(begin), len(line) - 1
    shifted = [Fraction(0)]  # powers of t, s = a + h·t, by Horner's rule on polynomials
    for coefficient in reversed(line):
        times_s = [a * x for x in shifted] + [Fraction(0)]
        for power, x in enumerate(shifted):
            times_s[power + 1] += h * x
        times_s[0] += Fraction(coefficient)
        shifted = times_s
    return [
        sum((Fraction(math.comb(i, j), math.comb(r, j)) * shifted[j] for j in range(i + 1)), Fraction(0))
        for i in range(r + 1)
    ]


def range_of(line: Sequence[float], path_m: tuple[float, float], pieces: int = 16) -> tuple[float, float]:
    """Bounds of the exact polynomial on the path, from Bernstein coefficients on equal pieces: outside, and close."""
    begin, end = path_m
    edges = [begin + (end - begin) * i / pieces for i in range(pieces)] + [end]
    values = [float(x) for low, high in pairwise(edges) for x in bernstein(line, low, high)]
    return min(values), max(values)


def error_bound(line: Sequence[float], begin: float, end: float) -> float:
    """What float32 Horner evaluation can be wrong by anywhere on [begin, end]; infinite where it might overflow."""
    reach = max(abs(begin), abs(end))
    low = high = line[-1]  # of the exact intermediate value
    error = 0.0
    for coefficient in line[-2::-1]:
        largest = max(abs(low), abs(high)) + error  # of the computed value so far
        products = (low * begin, low * end, high * begin, high * end)
        low, high = min(products) + coefficient, max(products) + coefficient
        carried = error * reach + HALF_ULP * largest * reach + SMALLEST
        error = (carried + HALF_ULP * max(abs(low), abs(high))) / (1.0 - HALF_ULP) * DOUBLE_ALLOWANCE
        if max(largest * reach, max(abs(low), abs(high)) + error) >= LARGEST / 2:
            return math.inf
    return error
