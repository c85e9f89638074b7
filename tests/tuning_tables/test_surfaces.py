"""Tables that decide at any time, with slopes over the pressure: what they answer, and what they must be."""

import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tuning_tables import ControllerTable, Decisions, InvalidTable, Stage, decide_for, decide_many
from tuning_tables.active_table import active
from tuning_tables.golden_vectors import golden_vectors
from tuning_tables.rule import rises_at

NAN, INF = float("nan"), float("inf")
SLOPE = "slope_m_s_per_kpa"

Change = dict[str, Any]


def with_stage(table: ControllerTable, k: int, **changes: Any) -> ControllerTable:
    stages = tuple(replace(stage, **changes) if stage.k == k else stage for stage in table.stages)
    return replace(table, stages=stages)


@pytest.fixture(scope="module")
def tilted_table(linear_table: ControllerTable) -> ControllerTable:
    """The linear table with slopes that are exact: raise above 4 + s/4 - P/32, lower below 2 + s/4 - (P - 128)/64."""
    stages = (Stage(0, 0.0, None, (4.0, 0.25), None, -(2.0**-5)), Stage(1, 128.0, (2.0, 0.25), None, -(2.0**-6), None))
    return replace(linear_table, id="tilted", stages=stages, decisions=Decisions.AT_ANY_TIME)


def above(value: float) -> float:
    return float(np.nextafter(np.float32(value), np.float32(INF)))


def below(value: float) -> float:
    return float(np.nextafter(np.float32(value), np.float32(-INF)))


@pytest.mark.requirement("RULE-08")
@pytest.mark.parametrize(
    ("stage", "kpa", "line"),
    [
        (0, 0.0, 5.0),
        (0, 64.0, 3.0),
        (0, 128.0, 1.0),
        (0, 128.5, 1.0),  # clamped to the pressure of the highest stage
        (0, 3.4e38, 1.0),
        (0, 5e-324, 5.0),  # 0 in float32
        (0, -0.0, 5.0),
        (0, -50.0, 5.0),  # clamped to the pressure of stage 0
        (0, -3.4e38, 5.0),
        (0, NAN, 5.0),  # the gauge is silent: the pressure of the stage
        (0, INF, 5.0),
        (0, 1e39, 5.0),
        (0, -1e39, 5.0),
        (1, 128.0, 3.0),
        (1, 64.0, 4.0),
        (1, 0.0, 5.0),
        (1, -50.0, 5.0),
        (1, 500.0, 3.0),
        (1, NAN, 3.0),
        (1, INF, 3.0),
        (1, -INF, 3.0),
    ],
)
def test_the_rule_on_surfaces_that_can_be_checked_by_hand(
    tilted_table: ControllerTable, stage: int, kpa: float, line: float
) -> None:
    for speed, answer in ((above(line), 1), (line, stage), (below(line), 0)):
        assert decide_for(tilted_table, stage, 4.0, speed, kpa) == answer
        assert decide_for(active(tilted_table), stage, 4.0, speed, kpa) == answer
        assert decide_many(tilted_table, stage, 4.0, speed, kpa) == answer


@pytest.mark.requirement("RULE-08")
def test_one_who_gives_no_pressure_is_one_whose_gauge_is_silent(tilted_table: ControllerTable) -> None:
    for stage in (0, 1):
        for speed in (2.0, above(3.0), below(3.0), above(5.0)):
            silent = decide_for(tilted_table, stage, 4.0, speed, NAN)
            assert decide_for(tilted_table, stage, 4.0, speed) == silent
            assert decide_many(tilted_table, stage, 4.0, speed) == silent


def test_the_highest_pressure_is_that_of_the_highest_stage_that_is_raised_to(surface_table: ControllerTable) -> None:
    table = with_stage(surface_table, 3, lower_slope_m_s_per_kpa=-(2.0**-7))
    assert table.highest_raised == active(table).highest_raised == 2
    at_299, at_300, at_301, at_most = (rises_at(table, 1, np.array(kpa)) for kpa in (299.0, 300.0, 301.0, 3.4e38))
    assert (at_300 == at_301).all()
    assert (at_300 == at_most).all()
    assert (at_300 != at_299).any()
    # Stage 3 is above it: a pressure as its own counts as that of stage 2, silence as its own.
    assert rises_at(table, 3, np.array([450.0, 300.0])).tolist() == [[150.0 / 128.0, 0.0]] * 2
    assert rises_at(table, 3, np.array(NAN)).tolist() == [0.0, 0.0]


@pytest.mark.requirement("RULE-02")
@pytest.mark.parametrize("stage", [-1, 4, -(2**31), 2**31])
def test_a_stage_that_there_is_not_holds(surface_table: ControllerTable, stage: int) -> None:
    assert decide_for(surface_table, stage, 1.0, 9.0, 100.0) == stage
    assert decide_many(surface_table, stage, 1.0, 9.0, 100.0) == stage


@pytest.mark.parametrize("top_kpa", [450.0, 1e39])
def test_a_table_without_slopes_answers_the_same_at_every_pressure(
    approached_table: ControllerTable, top_kpa: float
) -> None:
    # Who has no gauge may give any pressure, one beyond float32 too.
    table = with_stage(approached_table, 3, pressure_kpa=top_kpa)
    for each in (table, replace(table, decisions=Decisions.AT_ANY_TIME)):
        golden = golden_vectors(each)
        for kpa in (0.0, -5.0, 130.0, 450.0, 3.4e38, 1e39, NAN, INF, -INF):
            answers = decide_many(each, golden.stage, golden.s_m, golden.v_m_s, kpa)
            assert np.array_equal(answers, golden.answer)
            for stage in range(4):
                assert decide_for(each, stage, 5.0, 9.0, kpa) == decide_for(each, stage, 5.0, 9.0)


def test_arrays_hold_slopes_and_pressures_and_are_read_only(surface_table: ControllerTable) -> None:
    slopes = [[0.0, -0.004], [-0.006, -0.005], [-0.003, 0.0], [0.0, 0.0]]
    assert np.array_equal(surface_table.slopes, np.array(slopes, np.float32))
    assert surface_table.pressures.tolist() == [0.0, 150.0, 300.0, 450.0]
    assert surface_table.slopes.dtype == surface_table.pressures.dtype == np.float32
    for held in (surface_table, active(surface_table)):
        for array in (held.slopes, held.pressures):
            with pytest.raises(ValueError, match="read-only"):
                array[...] = 1


def test_a_gauge_and_the_times_of_decision_are_told_apart(
    surface_table: ControllerTable, surface_estimate: ControllerTable, table: ControllerTable
) -> None:
    assert (surface_table.has_gauge, surface_estimate.has_gauge, table.has_gauge) == (True, False, False)
    assert not table.slopes.any()
    assert active(surface_table).decisions is active(surface_estimate).decisions is Decisions.AT_ANY_TIME
    assert table.decisions is active(table).decisions is Decisions.AT_REST
    assert replace(table, decisions=Decisions.AT_ANY_TIME) != table
    copy = pickle.loads(pickle.dumps(surface_table))
    assert copy == surface_table
    assert hash(copy) == hash(surface_table)
    assert copy != with_stage(surface_table, 3, lower_slope_m_s_per_kpa=0.5)


@pytest.mark.parametrize("slope", [0.1, 1e39, NAN, INF, -0.0, True, "0.5", np.float32(0.5)], ids=repr)
@pytest.mark.parametrize("side", ["lower", "upper"])
def test_a_slope_is_a_float32_number(surface_table: ControllerTable, side: str, slope: Any) -> None:
    with pytest.raises(InvalidTable, match=rf"^stages\[1\]\.{side}_{SLOPE} is "):
        with_stage(surface_table, 1, **{f"{side}_{SLOPE}": slope})


@pytest.mark.parametrize(
    ("k", "change", "reason"),
    [
        (0, {f"lower_{SLOPE}": 0.0}, rf"^stages\[0\]\.lower_{SLOPE} is given, but stages\[0\]\.lower is null"),
        (2, {f"upper_{SLOPE}": -0.5}, rf"^stages\[2\]\.upper_{SLOPE} is given, but stages\[2\]\.upper is null"),
        (1, {"upper": None}, rf"^stages\[1\]\.upper_{SLOPE} is given, but"),
        (1, {f"lower_{SLOPE}": None}, rf"^stages\[1\]\.lower_{SLOPE} is missing, but another line has one"),
        (0, {f"upper_{SLOPE}": None}, rf"^stages\[0\]\.upper_{SLOPE} is missing"),
        (3, {"pressure_kpa": 1e39}, r"^stages\[3\]\.pressure_kpa is 1e\+39, which exceeds what float32 can hold"),
        (2, {f"lower_{SLOPE}": 2.0**127}, r"^stages\[2\]\.lower is .* exceeds the float32 range"),
    ],
)
def test_lines_and_slopes_belong_together(surface_table: ControllerTable, k: int, change: Change, reason: str) -> None:
    with pytest.raises(InvalidTable, match=reason):
        with_stage(surface_table, k, **change)


@pytest.mark.parametrize("decisions", ["at_any_time", None, True])
def test_the_times_of_decision_are_one_of_two(surface_table: ControllerTable, decisions: Any) -> None:
    with pytest.raises(InvalidTable, match=r"^decisions is "):
        replace(surface_table, decisions=decisions)


def test_a_table_that_decides_at_rest_has_no_slopes(surface_table: ControllerTable) -> None:
    with pytest.raises(InvalidTable, match=rf"^stages\[0\]\.upper_{SLOPE} is given, but .* decisions are at rest"):
        replace(surface_table, decisions=Decisions.AT_REST)
