"""One rule, three ways to ask it, the same float32 answer from all."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numba
import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import HealthCheck, given, settings

from synth.kernels.compiled_rules import compiled_rule
from tests.effort import sized
from tests.tuning_tables.random_tables import tables
from tuning_tables import ControllerTable, Decisions, Stage, ValidRange, decide_for, decide_many
from tuning_tables.active_table import active
from tuning_tables.golden_vectors import golden_vectors
from tuning_tables.programs.decide import decide
from tuning_tables.programs.held import LineTable
from tuning_tables.stage import Line

NAN, INF = float("nan"), float("inf")


def exact_horner(line: Line, s: np.float32) -> np.float32:
    """The line in float32, each step in double precision and then rounded: an independent way to the same number."""
    value = np.float32(line[-1])
    for coefficient in reversed(line[:-1]):
        # A product of two float32 numbers is exact in double precision; each rounding is then made explicitly.
        product = np.float32(float(value) * float(s))
        value = np.float32(float(product) + float(coefficient))
    return value


def exact_surface(table: ControllerTable, stage: Stage, side: int, s: np.float32, kpa: np.float32) -> np.float32:
    """`exact_horner` of a line, and likewise what the pressure adds to it."""
    line, slope = stage.lines[side], stage.slopes[side]
    assert line is not None
    on_line = exact_horner(line, s)
    if slope is None or not np.isfinite(kpa):
        return on_line
    # An upper line leads to the next stage, so the first stage without one is the highest that is raised to.
    highest = table.stages[min(each.k for each in table.stages if each.upper is None)]
    lowest_kpa, highest_kpa, own_kpa = (np.float32(each.pressure_kpa) for each in (table.stages[0], highest, stage))
    above = np.float32(float(min(max(kpa, lowest_kpa), highest_kpa)) - float(own_kpa))
    return np.float32(float(on_line) + float(np.float32(slope * float(above))))


Floats = npt.NDArray[np.float32]
Readings = tuple[npt.NDArray[np.int64], Floats, Floats, Floats]
"""Stages, paths, speeds, pressures."""
Answering = Callable[..., npt.NDArray[np.int64]]

TABLES = ("table", "approached_table", "turning_table", "surface_table", "surface_estimate")


def adversarial_readings(table: ControllerTable, rng: np.random.Generator, count: int) -> Readings:
    """Readings on the lines, one float32 step beside them, at the ends, absurd ones; stages in and out of range."""
    stages = rng.integers(-2, len(table.stages) + 2, count)
    s = rng.uniform(-10.0, 60.0, count).astype(np.float32)
    s[::7] = rng.choice(
        np.array([0.0, -0.0, 37.45, 1e-45, 1e-39, 3.4e38, -3.4e38, NAN, INF, -INF], np.float32), s[::7].size
    )
    v = rng.uniform(-1.0, 10.0, count).astype(np.float32)
    v[::11] = rng.choice(np.array([0.0, -0.0, 1e-45, 1e-39, 3.4e38, NAN, INF, -INF], np.float32), v[::11].size)
    kpa = rng.uniform(-100.0, 600.0, count).astype(np.float32)
    kpa[::5] = rng.choice(
        np.array([0.0, -0.0, 1e-45, 150.0, 300.0, 450.0, 3.4e38, -3.4e38, NAN, INF, -INF], np.float32), kpa[::5].size
    )
    for index in range(0, count, 3):
        stage = table.stages[rng.integers(len(table.stages))]
        side = int(rng.integers(2))
        side = side if stage.lines[side] is not None else 1 - side
        clamped = np.clip(s[index], *table.valid_range[:2])
        if np.isfinite(clamped):
            stages[index] = stage.k
            on_line = exact_surface(table, stage, side, clamped, kpa[index])
            just_below, just_above = np.nextafter(on_line, np.array([0.0, INF], np.float32))
            v[index] = (on_line, just_below, just_above)[index % 9 // 3]
    return stages, s, v, kpa


@pytest.fixture(scope="module")
def compiled() -> Answering:
    """`decide` compiled as it stands, for arrays of readings of one table."""
    one, jit = compiled_rule(decide), numba.njit

    def run(held: LineTable, stages: npt.NDArray[np.int64], s: Floats, v: Floats, kpa: Floats) -> npt.NDArray[np.int64]:
        answers = np.empty(stages.size, dtype=np.int64)
        for index in range(stages.size):
            answers[index] = one(held, stages[index], s[index], v[index], kpa[index])
        return answers

    compiled_run: Any = jit(run)

    def of_table(table: ControllerTable, *readings: npt.NDArray[Any]) -> npt.NDArray[np.int64]:
        answers: npt.NDArray[np.int64] = compiled_run(table.held, *readings)
        return answers

    return of_table


@pytest.mark.parametrize("name", TABLES)
def test_the_three_ways_agree_everywhere(name: str, request: pytest.FixtureRequest, compiled: Answering) -> None:
    table: ControllerTable = request.getfixturevalue(name)
    readings = adversarial_readings(table, np.random.default_rng(20261120), 60_000)
    many = decide_many(table, *readings)
    plain = np.array([decide_for(table, stage, *rest) for stage, *rest in zip(*readings, strict=True)])
    assert np.count_nonzero(many != plain) == 0
    assert np.count_nonzero(compiled(table, *readings) != plain) == 0
    # All answers occur often, so that the agreement means something.
    far = plain - readings[0]
    assert min(np.count_nonzero(far < 0), np.count_nonzero(far == 0), np.count_nonzero(far > 0)) > 3_000
    assert (np.count_nonzero(abs(far) > 1) > 1_000) == (table.farthest > 1)


@given(tables())
@settings(derandomize=True, max_examples=sized(10, 40), deadline=None, suppress_health_check=list(HealthCheck))
def test_the_three_ways_agree_on_tables_of_every_shape(compiled: Answering, table: ControllerTable) -> None:
    golden = golden_vectors(replace(table, target_speed_m_s=3.0))
    some = np.random.default_rng(len(golden)).permutation(len(golden))[:2_000]
    readings = [each[some] for each in (golden.stage, golden.s_m, golden.v_m_s, golden.pressure_kpa)]
    plain = [decide_for(table, stage, *rest) for stage, *rest in zip(*readings, strict=True)]
    assert plain == golden.answer[some].tolist() == compiled(table, *readings).tolist()


@pytest.mark.requirement("RULE-01", "RULE-04", "RULE-05")
@pytest.mark.parametrize("name", TABLES)
def test_answers_agree_with_an_independent_float32_evaluation(name: str, request: pytest.FixtureRequest) -> None:
    """A controller that sent a command for each stage, at once and with one reading, would end at the answer."""
    table: ControllerTable = request.getfixturevalue(name)
    stages, s, v, kpa = adversarial_readings(table, np.random.default_rng(1), 20_000)
    credible = np.isfinite(s) & np.isfinite(v) & (v >= 0) & (stages >= 0) & (stages < len(table.stages))
    readings = zip(stages[credible].tolist(), s[credible], v[credible], kpa[credible], strict=True)
    ties = gated = turned = far = back = 0

    def due(k: int, path: np.float32, speed: np.float32, pressure: np.float32) -> int:
        nonlocal ties, gated
        stage, clamped = table.stages[k], np.clip(path, *table.valid_range[:2])
        lower = -INF if stage.lower is None else exact_surface(table, stage, 0, clamped, pressure)
        upper = INF if stage.upper is None else exact_surface(table, stage, 1, clamped, pressure)
        ties += int(speed in (lower, upper))
        if table.approach is not None and path < 0.0 and k >= table.approach.entrance_stage:
            gated += int(speed > upper)
            upper = INF
        return -1 if speed < lower else 1 if speed > upper else 0

    for k, *reading in readings:
        wanted, step = k, due(k, *reading)
        if step != 0:
            wanted += step
            while table.decisions is Decisions.AT_REST and due(wanted, *reading) == step:
                wanted += step
            back += due(wanted, *reading) == -step
        assert decide_for(table, k, *reading) == wanted
        turned += decide_for(table, k, *reading[:2]) != wanted
        far += abs(wanted - k) > 1
    assert ties > 500
    assert (gated > 100) == (table.approach is not None)
    assert (turned > 500) == table.has_gauge
    assert (far > 300) == (table.decisions is Decisions.AT_REST)
    assert back > 100 or name != "turning_table"


@pytest.mark.requirement("RULE-01", "RULE-03")
@pytest.mark.parametrize(
    ("stage", "s_m", "v_m_s", "answer"),
    [
        (0, 4.0, 5.0, 0),  # tie with the upper line
        (0, 4.0, math.nextafter(5.0, 6.0), 0),  # a tie in float32
        (0, 4.0, float(np.nextafter(np.float32(5), np.float32(6))), 1),
        (0, 4.0, 0.0, 0),  # no lower line at stage 0
        (1, 4.0, 3.0, 1),  # tie with the lower line
        (1, 4.0, float(np.nextafter(np.float32(3), np.float32(2))), 0),
        (1, 4.0, 1e3, 1),  # no upper line at the top stage
        (1, 4.0, 0.0, 0),
        (1, 4.0, -0.0, 0),
        (0, -100.0, 4.25, 0),  # clamped to s = 1, where the line is at 4.25
        (0, -100.0, 4.5, 1),
        (0, 100.0, 6.0, 0),  # clamped to s = 8
        (0, 100.0, 6.5, 1),
        (0, 4.0, 3.4e38, 1),  # beyond the valid speeds, but a number
    ],
)
def test_the_rule_on_a_table_that_can_be_checked_by_hand(
    linear_table: ControllerTable, stage: int, s_m: float, v_m_s: float, answer: int
) -> None:
    assert decide_for(linear_table, stage, s_m, v_m_s) == answer
    assert decide_many(linear_table, stage, s_m, v_m_s) == answer


@pytest.mark.requirement("RULE-02")
@pytest.mark.parametrize(
    ("stage", "s_m", "v_m_s"),
    [
        (1, NAN, 0.0),
        (1, INF, 0.0),
        (1, -INF, 0.0),
        (1, 1e39, 0.0),
        (1, 4.0, NAN),
        (1, 4.0, -1e-30),
        (0, 4.0, INF),
        (0, 4.0, 1e300),
        (2, 4.0, 0.0),
        (-1, 4.0, 0.0),
        (0, NAN, NAN),
    ],
)
def test_an_incredible_reading_moves_no_valve(
    linear_table: ControllerTable, stage: int, s_m: float, v_m_s: float
) -> None:
    # The same reading with credible numbers does ask for a change, so that holding is an answer to what is incredible.
    assert decide_for(linear_table, 1, 4.0, 0.0) == 0
    assert decide_for(linear_table, 0, 4.0, 9.0) == 1
    assert decide_for(linear_table, stage, s_m, v_m_s) == stage
    assert decide_many(linear_table, stage, s_m, v_m_s) == stage


@pytest.mark.requirement("RULE-04")
@pytest.mark.parametrize(
    ("stage", "v_m_s", "answer"),
    [
        (0, 4.0, 0),  # a tie
        (0, 4.5, 1),
        (0, 5.5, 2),  # at stage 1 too fast, too
        (1, 5.5, 2),
        (2, 5.5, 2),
        (0, 6.5, 3),  # stage 2 raises, stage 3 would lower: the opposite answer ends it
        (2, 6.5, 3),
        (3, 6.5, 2),  # stage 3 lowers, stage 2 would raise
        (4, 6.5, 2),
        (0, 7.5, 3),
        (0, 7.75, 4),
        (4, 8.0, 4),  # a tie
        (4, 2.5, 0),
        (4, 3.5, 1),
        (3, 5.5, 2),
    ],
)
def test_a_jump_that_can_be_checked_by_hand(
    turning_table: ControllerTable, stage: int, v_m_s: float, answer: int
) -> None:
    assert turning_table.farthest == active(turning_table).farthest == 4
    assert decide_for(turning_table, stage, 0.0, v_m_s) == answer
    assert decide_many(turning_table, stage, 0.0, v_m_s) == answer
    assert decide_for(active(turning_table), stage, 0.0, v_m_s) == answer
    step = min(max(answer, stage - 1), stage + 1)
    assert decide_for(replace(turning_table, decisions=Decisions.AT_ANY_TIME), stage, 0.0, v_m_s) == step


@pytest.mark.requirement("RULE-05")
def test_subnormal_coefficients_are_not_flushed_to_zero(linear_table: ControllerTable) -> None:
    tiny = float(np.float32(1e-44))
    table = replace(
        linear_table,
        stages=(Stage(0, 0.0, None, (tiny, 0.0)), Stage(1, 1.0, None, None)),
        valid=ValidRange((0.0, 1.0), (0.0, 1.0)),
    )
    compiled = compiled_rule(decide)
    for v, answer in ((tiny, 0), (float(np.nextafter(np.float32(tiny), np.float32(1))), 1)):
        assert decide_for(table, 0, 0.5, v) == decide_many(table, 0, 0.5, v) == answer
        assert compiled(table.held, 0, 0.5, v, NAN) == answer


def test_many_broadcasts_and_refuses_stages_that_are_no_integers(linear_table: ControllerTable) -> None:
    answers = decide_many(linear_table, [[0], [1]], 4.0, [0.0, 4.0, 9.0])
    assert answers.tolist() == [[0, 0, 1], [0, 1, 1]]
    assert decide_many(linear_table, np.array([0, 1, 7], np.uint8), 4.0, 9.0).dtype == np.uint8
    with pytest.raises(TypeError, match="integers"):
        decide_many(linear_table, 0.0, 4.0, 4.0)
