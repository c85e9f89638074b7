"""The proof that lower(s) < upper(s) as float32 computes them, by subdivision.

On a piece of the path the exact difference of two lines is written in Bernstein form, in rational arithmetic: it is
nowhere less than its smallest coefficient (Farin, Curves and Surfaces, §5.4). Against it stands a running bound of
what Horner's rule in float32 can be wrong by on that piece (Higham, Accuracy and Stability, §5.1). Where the first is
not larger the piece is halved, until all is proved, or a float32 place is found at which the lines do touch, or too
many pieces are undecided.

With a slope over the pressure P a line is a surface. The exact distance of two surfaces is linear in P, so it is least
at an end of the pressures: there each rise is a constant. What float32 is wrong by in the difference P - P_k, in the
product with the slope and in the sum is bounded for all pressures between, and added to the bound of Horner's rule.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Final

from synth.checker.float32 import HALF_ULP, LARGEST, SMALLEST, above, below, horner, rise, rounded

MOST_PIECES: Final = 1000
DOUBLE_ALLOWANCE: Final = 1.0 + 1e-9
"""The running bound is itself computed in double precision."""
SAMPLES: Final = 96
PRESSURE_SAMPLES: Final = 12


@dataclass(frozen=True)
class Tilt:
    """How the lower and the upper line of a stage rise with the pressure.

    `slopes` in m/s per kPa; `own_kpa` the pressure of the stage, at which nothing is added; `range_kpa` the lowest and
    the highest pressure that the lines are compared at. All of them are float32 numbers.
    """

    slopes: tuple[float, float]
    own_kpa: float
    range_kpa: tuple[float, float]

    @property
    def reach_kpa(self) -> Fraction:
        """The farthest from the pressure of the stage."""
        return max(abs(Fraction(kpa) - Fraction(self.own_kpa)) for kpa in self.range_kpa)

    @property
    def least_gain_m_s(self) -> Fraction:
        """What the pressure adds to the distance of the two lines, exact, where that is least."""
        steeper = Fraction(self.slopes[1]) - Fraction(self.slopes[0])
        return min(steeper * (Fraction(kpa) - Fraction(self.own_kpa)) for kpa in self.range_kpa)

    def samples(self) -> list[float]:
        """Float32 pressures of the range: as `sample_places`, and that of the stage."""
        low, high = self.range_kpa
        return [*sample_places(self.range_kpa, PRESSURE_SAMPLES), min(max(self.own_kpa, low), high)]


LEVEL: Final = Tilt((0.0, 0.0), 0.0, (0.0, 0.0))
"""Of lines without slopes: they are the same at every pressure."""


@dataclass(frozen=True)
class Order:
    """How the comparison of two lines ended.

    `proved`: lower < upper on the whole path, at all pressures. Otherwise `touch_m` is a float32 path, and `touch_kpa`
    a float32 pressure, where lower >= upper as computed, or None if none was found: then the lines are too close for a
    proof, around `closest_m`.
    """

    proved: bool
    touch_m: float | None = None
    closest_m: float = math.nan
    touch_kpa: float | None = None


def compare(lower: Sequence[float], upper: Sequence[float], path_m: tuple[float, float], tilt: Tilt = LEVEL) -> Order:
    """Prove or refute the order of two float32 lines of one degree on [s0, s1], both ends float32 numbers."""
    pressures = [tilt.own_kpa] if tilt == LEVEL else tilt.samples()
    rises = [(kpa, *(rise(slope, tilt.own_kpa, kpa) for slope in tilt.slopes)) for kpa in pressures]

    def touch(s: float) -> Order | None:
        """A pressure at which the lines touch at `s`, if one of the samples is."""
        low, high = horner(lower, s), horner(upper, s)
        touched = (kpa for kpa, one, other in rises if not rounded(low + one) < rounded(high + other))
        return next((Order(False, s, s, kpa) for kpa in touched), None)

    for s in sample_places(path_m):
        if (found := touch(s)) is not None:
            return found
    difference = [Fraction(b) - Fraction(a) for a, b in zip(lower, upper, strict=True)]
    difference[0] += tilt.least_gain_m_s
    pieces = [path_m]
    for _ in range(MOST_PIECES):
        if not pieces:
            return Order(True)
        begin, end = pieces.pop()
        lines = zip((lower, upper), tilt.slopes, strict=True)
        error = sum(surface_error_bound(line, slope, tilt, begin, end) for line, slope in lines)
        if min(bernstein(difference, begin, end)) > error:
            continue
        middle = rounded(0.5 * (begin + end))
        if (found := touch(middle)) is not None:
            return found
        if not begin < middle < end:  # neighbours in float32, both of them looked at
            if tilt != LEVEL:  # but not at every pressure
                return Order(False, None, begin)
            continue
        pieces += [(begin, middle), (middle, end)]
    return Order(not pieces, None, pieces[-1][0] if pieces else math.nan)


def sample_places(path_m: tuple[float, float], count: int = SAMPLES) -> Iterator[float]:
    """Float32 places on the path: the ends, their inner neighbours, and an even row between."""
    begin, end = path_m
    yield from (begin, end, above(begin), below(end))
    for i in range(1, count):
        yield min(max(rounded(begin + (end - begin) * i / count), begin), end)


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


def surface_error_bound(line: Sequence[float], slope: float, tilt: Tilt, begin: float, end: float) -> float:
    """The same for a line that rises by `slope` with the pressure, for all pressures of `tilt`."""
    largest, error = reach_and_error(line, begin, end)
    if slope == 0.0:  # nothing is added, exactly
        return error
    most = abs(slope) * float(tilt.reach_kpa)
    # Two roundings, and the product may fall between the smallest numbers.
    of_rise = most * (2.0 + HALF_ULP) * HALF_ULP + SMALLEST
    total = largest + most + error + of_rise
    if total >= LARGEST / 2:
        return math.inf
    return (error + of_rise + HALF_ULP * total) * DOUBLE_ALLOWANCE


def reach_and_error(line: Sequence[float], begin: float, end: float) -> tuple[float, float]:
    """The largest that the exact line can be on [begin, end], and what float32 Horner evaluation can be wrong by."""
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
            return math.inf, math.inf
    return max(abs(low), abs(high)), error
