"""What is taken between two tables with slopes over the pressure, and between which it is not."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.effort import sized
from tests.tuning_tables.test_surfaces import above, with_stage
from tuning_tables import ControllerTable, Decisions, InvalidTable, Stage, TableBook
from tuning_tables.active_table import between, interpolable
from tuning_tables.stage import round_coefficients
from tuning_tables.table_book import Status


def faster(table: ControllerTable, **changes: Any) -> ControllerTable:
    """`table` for 1 m/s more, its lines moved so far, with slopes half as large again."""

    def moved(stage: Stage) -> Stage:
        lower, upper = (line and round_coefficients([line[0] + 1.0, *line[1:]]) for line in stage.lines)
        slopes = [None if slope is None else round_coefficients([1.5 * slope])[0] for slope in stage.slopes]
        return Stage(stage.k, stage.pressure_kpa, lower, upper, *slopes)

    made = replace(table, id="faster", target_speed_m_s=table.target_speed_m_s + 1.0)
    return replace(made, stages=tuple(moved(stage) for stage in table.stages), **changes)


def test_slopes_between_two_tables_are_taken_as_coefficients_are(surface_table: ControllerTable) -> None:
    other = faster(surface_table)
    choice = TableBook((surface_table, other)).choose("medium", 4, 4.3)
    assert choice.status is Status.BETWEEN
    assert choice.table is not None
    weight = np.float32(float(np.float32(4.3)) - 4.0)  # exact: the two are within a factor of two
    for k, side in np.argwhere(surface_table.has_line):
        low, high = float(surface_table.slopes[k, side]), float(other.slopes[k, side])
        rise = np.float32(float(weight) * float(np.float32(high - low)))
        assert choice.table.slopes[k, side] == np.float32(low + float(rise))
    assert not choice.table.slopes[~surface_table.has_line].any()
    assert np.array_equal(choice.table.pressures, surface_table.pressures)
    assert choice.table.decisions is Decisions.AT_ANY_TIME
    assert choice.table.highest_raised == 2
    with pytest.raises(ValueError, match="read-only"):
        choice.table.slopes[0, 1] = 1.0


def test_the_ends_of_an_interpolation(surface_table: ControllerTable) -> None:
    other = faster(surface_table)
    assert np.array_equal(between(surface_table, other, np.float32(4.0)).slopes, surface_table.slopes)
    assert np.allclose(between(surface_table, other, np.float32(5.0)).slopes, other.slopes, rtol=1e-6)


def without_slopes(table: ControllerTable) -> ControllerTable:
    return replace(table, stages=tuple(Stage(s.k, s.pressure_kpa, s.lower, s.upper) for s in table.stages))


@pytest.mark.parametrize(
    ("change", "between_them"),
    [
        (lambda table: table, True),
        (lambda table: with_stage(table, 3, pressure_kpa=451.0), False),
        (lambda table: with_stage(table, 1, pressure_kpa=above(150.0)), False),
        (lambda table: with_stage(table, 1, pressure_kpa=math.nextafter(150.0, 151.0)), True),  # the same float32
        (without_slopes, False),
        (lambda table: replace(without_slopes(table), decisions=Decisions.AT_REST), False),
    ],
)
def test_surfaces_of_other_pressures_or_another_gauge_are_not_mixed(
    surface_table: ControllerTable, change: Callable[[ControllerTable], ControllerTable], between_them: bool
) -> None:
    other = change(faster(surface_table))
    assert interpolable(surface_table, other) == interpolable(other, surface_table) == between_them
    choice = TableBook((surface_table, other)).choose("medium", 4, 4.5)
    assert choice.status is (Status.BETWEEN if between_them else Status.SLOWER)
    assert choice.numbers == ((0, 1) if between_them else (0,))


def test_without_a_gauge_the_pressures_may_differ_but_not_the_times(surface_table: ControllerTable) -> None:
    plain = without_slopes(surface_table)
    other = with_stage(faster(plain), 3, pressure_kpa=500.0)
    assert TableBook((plain, other)).choose("medium", 4, 4.5).status is Status.BETWEEN
    at_rest = replace(other, decisions=Decisions.AT_REST)
    assert TableBook((plain, at_rest)).choose("medium", 4, 4.5).status is Status.SLOWER


def thin(
    table: ControllerTable, target: float, lower: float, gap: float, slopes: tuple[float, float]
) -> ControllerTable:
    """Stages at 0, 100 and 200 kPa with constant lines, in the middle `gap` apart and with these slopes."""
    low, high, *rounded = round_coefficients([lower, lower + gap, *slopes])
    middle = Stage(1, 100.0, (low,), (high,), *rounded)
    stages = (Stage(0, 0.0, None, (9.0,), None, 0.0), middle, Stage(2, 200.0, (0.0,), None, 0.0, None))
    made = replace(table, id=f"thin-{target:g}", target_speed_m_s=target, degree=0, stages=stages, approach=None)
    return replace(made, decisions=Decisions.AT_ANY_TIME)


@pytest.mark.parametrize(("slope", "apart"), [(0.0, True), (0.01, True), (1.0, False)])
def test_steep_surfaces_too_near_to_be_interpolated_are_refused(
    surface_table: ControllerTable, slope: float, apart: bool
) -> None:
    # 1e-4 m/s are enough for each table; where 100 m/s are added, what lies between two of them needs more.
    tables = tuple(thin(surface_table, target, target + 1.0, 1e-4, (slope, slope)) for target in (2.0, 3.0))
    assert [TableBook((table,)).tables for table in tables] == [(table,) for table in tables]
    if apart:
        assert len(TableBook(tables).tables) == 2
    else:
        with pytest.raises(InvalidTable, match=r"stages\[1\]: the lines between thin-2 and thin-3 come within"):
            TableBook(tables)


slopes_of_a_stage = st.tuples(st.floats(-2.0, 2.0, width=32), st.floats(-1e-7, 1e-7)).map(
    lambda drawn: (drawn[0] + 0.0, drawn[0] + drawn[1] + 0.0)
)


@given(
    lower=st.tuples(st.floats(-8.0, 8.0), st.floats(-8.0, 8.0)),
    gap=st.tuples(st.floats(1e-6, 1e-3), st.floats(1e-6, 1e-3)),
    slopes=st.tuples(slopes_of_a_stage, slopes_of_a_stage),
    seed=st.integers(0, 2**32 - 1),
)
@settings(derandomize=True, max_examples=sized(37, 150), deadline=None)
def test_surfaces_between_accepted_ones_never_cross_in_float32(
    surface_table: ControllerTable,
    lower: tuple[float, float],
    gap: tuple[float, float],
    slopes: tuple[tuple[float, float], tuple[float, float]],
    seed: int,
) -> None:
    try:
        slower, faster_one = (thin(surface_table, 2.0 + i, lower[i], gap[i], slopes[i]) for i in (0, 1))
        TableBook((slower, faster_one))
    except InvalidTable:
        assume(False)
    chance = np.random.default_rng(seed)
    kpa = np.concatenate([chance.uniform(0.0, 200.0, 200), [0.0, 100.0, 200.0]]).astype(np.float32)
    for target in chance.uniform(2.0, 3.0, 20).astype(np.float32):
        lines = between(slower, faster_one, target)
        values = lines.coefficients[1] + lines.slopes[1][:, np.newaxis] * (kpa - lines.pressures[1])
        assert np.all(values[0] < values[1])
