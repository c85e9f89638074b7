"""The proof of the order of lines and of surfaces against the exporter's own, found by another method."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from synth.checker.float32 import horner, rise, rises, rounded
from synth.checker.line_order import (
    LEVEL,
    Tilt,
    bernstein,
    compare,
    range_of,
    reach_and_error,
    sample_places,
    surface_error_bound,
)
from synth.checker.table_reading import read_table
from synth.checker.table_sense import tilt_of
from tests.checker.any_time_tables import sloped, sound_table
from tuning_tables import Stage, to_json
from tuning_tables.errors import InvalidTable
from tuning_tables.stage import require_order, require_stage, rounding_bound, smallest_gap, stage_gap, surface_bound

LINE = st.lists(st.floats(-4, 4, width=32), min_size=4, max_size=4)


def exporter_accepts(lower: tuple[float, ...], upper: tuple[float, ...]) -> bool:
    try:
        require_order(lower, upper, PATH, "lines")
    except InvalidTable:
        return False
    return True


@given(LINE, LINE, st.floats(-3.0, 3.0))
def test_verdicts_on_lines_agree_but_in_a_thin_band(one: list[float], other: list[float], shift: float) -> None:
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


Floats = npt.NDArray[np.float32]

PATH = (-4.0, float(np.float32(37.45)))
SLOPE = st.floats(-(2.0**-7), 2.0**-7, width=32).map(lambda x: x + 0.0)
OWN, RANGE = 150.0, (0.0, 450.0)


def scaled(line: list[float], above: float = 0.0) -> tuple[float, ...]:
    """Coefficients that all count on the path."""
    return tuple(rounded(c / 40.0**power + (above if power == 0 else 0.0)) + 0.0 for power, c in enumerate(line))


def test_a_table_without_slopes_adds_nothing() -> None:
    own = read_table(to_json(sound_table("none")))
    for stage in (-1, 0, 1, 2, 3):
        assert rises(own.slopes, own.pressures_kpa, own.top_stage, stage, 217.0) == (0.0, 0.0)


def stage_of(lower: tuple[float, ...], upper: tuple[float, ...], slopes: tuple[float, float]) -> Stage:
    return Stage(1, OWN, lower, upper, *slopes)


@given(LINE, LINE, SLOPE, SLOPE, st.floats(0.0, 4.0))
def test_verdicts_agree_but_in_a_thin_band(
    one: list[float], other: list[float], slope: float, steeper: float, shift: float
) -> None:
    lower, upper = scaled(one), scaled(other, shift)
    tilt, above = Tilt((slope, steeper), OWN, RANGE), (RANGE[0] - OWN, RANGE[1] - OWN)
    order, stage = compare(lower, upper, PATH, tilt), stage_of(lower, upper, (slope, steeper))
    try:
        require_stage(stage, PATH, above, "stage")
    except InvalidTable:
        pass
    else:
        assert order.proved  # the exporter's bound is the coarser one
    if order.touch_m is not None:
        assert order.touch_kpa is not None
        low, high = (
            rounded(horner(line, order.touch_m) + rise(each, OWN, order.touch_kpa))
            for line, each in ((lower, slope), (upper, steeper))
        )
        assert not low < high
    gap = stage_gap(stage, PATH, above)
    bounds = sum(surface_bound(line, each, PATH, above) for line, each in ((lower, slope), (upper, steeper)))
    if gap > 1.01 * bounds + 1e-12:
        assert order.proved
    elif gap < -1e-3:
        assert not order.proved


@given(LINE, SLOPE, st.integers(0, 40), st.sampled_from([0.0, -0.004, 0.004]))
def test_surfaces_that_just_touch_are_told_from_those_that_do_not(
    line: list[float], slope: float, ulps: int, apart: float
) -> None:
    """At one end of the pressures 0 to 40 steps of rounding apart: proved only where no float32 reading contradicts."""
    lower, steeper = scaled([4.0 + abs(line[0]), *line[1:]]), rounded(slope + apart)
    tilt = Tilt((slope, steeper), OWN, RANGE)
    lift = max(0.0, *((slope - steeper) * (kpa - OWN) for kpa in RANGE))
    upper = (rounded(lower[0] + lift + ulps * 2.0**-21), *lower[1:])
    order = compare(lower, upper, PATH, tilt)
    places, pressures = np.linspace(*PATH, 300, dtype=np.float32), np.linspace(*RANGE, 40, dtype=np.float32)
    rows = [
        horner_of(each, places)[:, None] + np.float32(a) * (pressures - np.float32(OWN))[None, :]
        for each, a in ((lower, slope), (upper, steeper))
    ]
    touching = bool((rows[0] >= rows[1]).any())
    assert not (order.proved and touching)
    if ulps > 30:
        assert order.proved


def horner_of(line: tuple[float, ...], s: Floats) -> Floats:
    value: Floats = np.full(s.shape, np.float32(line[-1]))
    for coefficient in line[-2::-1]:
        value = value * s + np.float32(coefficient)
    return value


@pytest.mark.parametrize(("slopes", "kpa"), [((0.002, -0.002), 450.0), ((-0.002, 0.004), 0.0)])
def test_a_crossing_at_one_end_of_the_pressures_only_is_found(slopes: tuple[float, float], kpa: float) -> None:
    lower, upper, exact = (4.0, -0.01), (4.8, -0.01), tuple(map(rounded, slopes))
    order = compare(lower, upper, PATH, Tilt((exact[0], exact[1]), OWN, RANGE))
    assert (order.proved, order.touch_kpa) == (False, kpa)
    for cut in ((0.0, 300.0), (60.0, 450.0)):
        assert compare(lower, upper, PATH, Tilt((exact[0], exact[1]), OWN, cut)).proved == (not cut[0] <= kpa <= cut[1])
    assert compare(lower, upper, PATH, LEVEL).proved


def test_a_narrow_crossing_between_all_samples_at_the_highest_pressure_is_found() -> None:
    """A dip of 10 cm around 20 m, which comes down to the lower line at 450 kPa alone: no sample lies in it."""
    centre, depth, width, slope = 20.03, 1e-3, 5e-2, -(2.0**-10)
    square, lift = depth / width**2, -slope * (RANGE[1] - OWN)
    lower = (3.0, 0.0, 0.0)
    upper = tuple(rounded(c) for c in (3.0 + lift + square * centre**2 - depth, -2 * square * centre, square))
    assert all(horner(lower, s) < horner(upper, s) + slope * (RANGE[1] - OWN) for s in sample_places(PATH))
    assert not compare(lower, upper, PATH, Tilt((0.0, slope), OWN, RANGE)).proved
    assert compare(lower, upper, PATH, Tilt((0.0, slope), OWN, (0.0, 448.0))).proved


@given(LINE, SLOPE, st.floats(-4.0, 37.0), st.floats(0.001, 5.0), st.floats(0.0, 450.0, width=32))
def test_the_bound_encloses_what_float32_computes(
    line: list[float], slope: float, begin: float, length: float, kpa: float
) -> None:
    tilt, each = Tilt((slope, slope), OWN, RANGE), scaled(line)
    a, b = rounded(begin), rounded(min(begin + length, PATH[1]))
    bound = surface_error_bound(each, slope, tilt, a, b)
    for s in np.linspace(a, b, 5, dtype=np.float32).tolist():
        exact = sum((Fraction(c) * Fraction(s) ** power for power, c in enumerate(each)), Fraction(0))
        exact += Fraction(slope) * (Fraction(kpa) - Fraction(OWN))
        assert abs(Fraction(rounded(horner(each, s) + rise(slope, OWN, kpa))) - exact) <= Fraction(bound)


def test_neighbours_in_float32_prove_nothing_for_pressures_that_were_not_looked_at() -> None:
    """Two steps of rounding apart: no reading of the samples contradicts, and the bound is larger."""
    path, lower, upper = (1.0, rounded(1.0 + 2.0**-23)), (4.0, 0.0), (4.0 + 2.0**-20, 0.0)
    assert compare(lower, upper, path, LEVEL).proved
    order = compare(lower, upper, path, Tilt((-(2.0**-9), -(2.0**-9)), OWN, RANGE))
    assert (order.proved, order.touch_m) == (False, None)


def test_a_rise_that_may_overflow_is_not_proved() -> None:
    assert not compare((0.0, 0.0), (1.0, 0.0), PATH, Tilt((1e36, 1e36), OWN, RANGE)).proved


def test_pressures_are_those_that_the_rule_computes_with() -> None:
    """Up to the highest stage that is raised to; each as float32 number."""
    table = sloped(sound_table("third"))
    stages = tuple(replace(stage, pressure_kpa=stage.pressure_kpa + 0.1 * (stage.k > 0)) for stage in table.stages)
    own = read_table(to_json(replace(table, stages=stages)))
    tilt = tilt_of(own, 1)
    assert (tilt.own_kpa, tilt.range_kpa) == (rounded(150.1), (0.0, rounded(300.1)))
    assert tilt.own_kpa != 150.1
    assert tilt_of(replace(own, slopes=((None, None),) * 3), 1) == LEVEL
