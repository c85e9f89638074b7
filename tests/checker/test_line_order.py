"""The proof of the order of lines against the exporter's own, found by another method."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from synth.checker.float32 import horner, rounded
from synth.checker.line_order import bernstein, compare, range_of, reach_and_error, sample_places
from tuning_tables.errors import InvalidTable
from tuning_tables.line_order import require_order, rounding_bound, smallest_gap

PATH = (0.0, float(np.float32(37.45)))
LINE = st.lists(st.floats(-4, 4, width=32), min_size=4, max_size=4)


def scaled(line: Sequence[float]) -> tuple[float, ...]:
    """Coefficients that all count on the path."""
    return tuple(float(np.float32(c / 40.0**power)) for power, c in enumerate(line))


def exporter_accepts(lower: tuple[float, ...], upper: tuple[float, ...]) -> bool:
    try:
        require_order(lower, upper, PATH, "lines")
    except InvalidTable:
        return False
    return True


@given(LINE, LINE, st.floats(-3.0, 3.0))
def test_verdicts_agree_but_in_a_thin_band(one: list[float], other: list[float], shift: float) -> None:
    lower, upper = scaled(one), scaled([other[0] + shift, *other[1:]])
    order = compare(lower, upper, PATH)
    if exporter_accepts(lower, upper):
        assert order.proved  # the exporter's bound is the coarser one
    if order.touch_m is not None:
        assert not horner(lower, order.touch_m) < horner(upper, order.touch_m)
    gap, _ = smallest_gap(lower, upper, PATH)
    if gap > 1.01 * (rounding_bound(lower, PATH) + rounding_bound(upper, PATH)) + 1e-12:
        assert order.proved
    elif gap < -1e-3:
        assert not order.proved


@given(LINE, st.integers(0, 40))
def test_lines_that_just_touch_are_told_from_lines_that_do_not(line: list[float], ulps: int) -> None:
    """Parallel lines, 0 to 40 steps of rounding apart: proved only where no float32 place contradicts."""
    lower = scaled([4.0 + abs(line[0]), *line[1:]])
    upper = (float(np.float32(lower[0] + ulps * 2.0**-21)), *lower[1:])
    order = compare(lower, upper, PATH)
    places = np.linspace(*PATH, 2000, dtype=np.float32).tolist()
    touching = any(not horner(lower, s) < horner(upper, s) for s in places)
    assert not (order.proved and touching)
    if ulps == 0:
        assert order.touch_m is not None
    if ulps > 30:
        assert order.proved


def test_a_narrow_crossing_between_all_samples_is_found() -> None:
    """A dip of 10 cm around 20 m: no sample lies in it."""
    centre, depth, width = 20.0, 1e-3, 5e-2
    square = depth / width**2
    lower = tuple(rounded(c) for c in (3.0, 0.0, 0.0))
    upper = tuple(rounded(c) for c in (3.0 + square * centre**2 - depth, -2 * square * centre, square))
    assert all(horner(lower, s) < horner(upper, s) for s in sample_places(PATH))
    assert not compare(lower, upper, PATH).proved


@given(LINE, st.floats(0.0, 37.0), st.floats(0.001, 1.0))
def test_bounds_enclose(line: list[float], begin: float, length: float) -> None:
    scaled_line = scaled(line)
    a, b = rounded(begin), rounded(min(begin + length, PATH[1]))
    exact = np.polynomial.Polynomial(scaled_line)
    coefficients = [float(c) for c in bernstein(scaled_line, a, b)]
    low, high = range_of(scaled_line, (a, b))
    for s in np.linspace(a, b, 9, dtype=np.float32).tolist():
        value = exact(s)
        assert min(coefficients) - 1e-12 <= value <= max(coefficients) + 1e-12
        assert low - 1e-12 <= value <= high + 1e-12
        assert abs(horner(scaled_line, s) - value) <= reach_and_error(scaled_line, a, b)[1] + 1e-15


def test_overflow_is_not_proved() -> None:
    assert not compare((0.0, 1e38), (1.0, 1.5e38), (1.0, 37.0)).proved


@pytest.mark.parametrize("degree", [0, 1, 9])
def test_every_degree(degree: int) -> None:
    line = tuple(rounded(0.5 / 40.0**power) for power in range(degree + 1))
    above = (rounded(line[0] + 0.04), *line[1:])
    assert compare(line, above, PATH).proved
    assert not compare(above, line, PATH).proved
