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

from tests.tuning_tables.random_tables import tables
from tuning_tables import HOLD, LOWER, RAISE, ControllerTable, Stage, ValidRange, decide, decide_for, decide_many
from tuning_tables.golden_vectors import golden_vectors
from tuning_tables.rule import rises, stage_for
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
Answering = Callable[..., npt.NDArray[np.int8]]


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
    """`decide` and `rises` compiled as they stand, for arrays of readings of one table."""
    jit: Any = numba.njit
    one, rises_of_one = jit(decide), jit(rises)

    def run(
        lines: tuple[Any, ...],
        surfaces: tuple[Any, ...],
        stages: npt.NDArray[np.int64],
        s: Floats,
        v: Floats,
        kpa: Floats,
    ) -> npt.NDArray[np.int8]:
        coefficients, has_line, valid_range, entrance_stage = lines
        slopes, pressures, highest_raised = surfaces
        answers = np.empty(stages.size, dtype=np.int8)
        for index in range(stages.size):
            rise = rises_of_one(slopes, pressures, highest_raised, stages[index], kpa[index])
            answers[index] = one(
                coefficients,
                has_line,
                valid_range,
                entrance_stage,
                stages[index],
                s[index],
                v[index],
                rise,
            )
        return answers

    compiled_run: Any = jit(run)

    def of_table(table: ControllerTable, *readings: npt.NDArray[Any]) -> npt.NDArray[np.int8]:
        lines = (table.coefficients, table.has_line, table.valid_range, table.entrance_stage)
        answers: npt.NDArray[np.int8] = compiled_run(
            lines, (table.slopes, table.pressures, table.highest_raised), *readings
        )
        return answers

    return of_table


@pytest.mark.parametrize("name", ["table", "approached_table", "surface_table", "surface_estimate"])
def test_the_three_ways_agree_everywhere(name: str, request: pytest.FixtureRequest, compiled: Answering) -> None:
    table: ControllerTable = request.getfixturevalue(name)
    readings = adversarial_readings(table, np.random.default_rng(20261120), 60_000)
    many = decide_many(table, *readings)
    plain = np.array([decide_for(table, stage, *rest) for stage, *rest in zip(*readings, strict=True)])
    assert np.count_nonzero(many != plain) == 0
    assert np.count_nonzero(compiled(table, *readings) != plain) == 0
    # All answers occur often, so that the agreement means something.
    assert np.all(np.bincount(plain + 1) > 3_000)


@given(tables())
@settings(derandomize=True, max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
def test_the_three_ways_agree_on_tables_of_every_shape(compiled: Answering, table: ControllerTable) -> None:
    golden = golden_vectors(replace(table, target_speed_m_s=3.0))
    some = np.random.default_rng(len(golden)).permutation(len(golden))[:2_000]
    readings = [each[some] for each in (golden.stage, golden.s_m, golden.v_m_s, golden.pressure_kpa)]
    plain = [decide_for(table, stage, *rest) for stage, *rest in zip(*readings, strict=True)]
    assert plain == golden.answer[some].tolist() == compiled(table, *readings).tolist()


@pytest.mark.parametrize("name", ["table", "approached_table", "surface_table", "surface_estimate"])
def test_answers_agree_with_an_independent_float32_evaluation(name: str, request: pytest.FixtureRequest) -> None:
    table: ControllerTable = request.getfixturevalue(name)
    stages, s, v, kpa = adversarial_readings(table, np.random.default_rng(1), 20_000)
    credible = np.isfinite(s) & np.isfinite(v) & (v >= 0) & (stages >= 0) & (stages < len(table.stages))
    readings = zip(stages[credible].tolist(), s[credible], v[credible], kpa[credible], strict=True)
    ties = gated = turned = 0
    for k, path, speed, pressure in readings:
        stage = table.stages[k]
        clamped = np.clip(path, *table.valid_range[:2])
        lower = -INF if stage.lower is None else exact_surface(table, stage, 0, clamped, pressure)
        upper = INF if stage.upper is None else exact_surface(table, stage, 1, clamped, pressure)
        ties += speed in (lower, upper)
        if table.approach is not None and path < 0.0 and k >= table.approach.entrance_stage:
            gated += speed > upper
            upper = INF
        due = LOWER if speed < lower else RAISE if speed > upper else HOLD
        assert decide_for(table, k, path, speed, pressure) == due
        turned += decide_for(table, k, path, speed) != due
    assert ties > 500
    assert (gated > 100) == (table.approach is not None)
    assert (turned > 500) == table.has_gauge


def test_both_float_widths_of_a_reading_agree_in_compiled_code(table: ControllerTable) -> None:
    compiled: Any = numba.njit(decide)
    arrays = (table.coefficients, table.has_line, table.valid_range, table.entrance_stage)
    for s in np.linspace(0.0, 37.0, 50):
        for v in np.linspace(4.0, 7.0, 50):
            assert compiled(*arrays, 1, float(s), float(v)) == compiled(*arrays, 1, np.float32(s), np.float32(v))


@pytest.mark.parametrize(
    ("stage", "s_m", "v_m_s", "answer"),
    [
        (0, 4.0, 5.0, HOLD),  # tie with the upper line
        (0, 4.0, math.nextafter(5.0, 6.0), HOLD),  # a tie in float32
        (0, 4.0, float(np.nextafter(np.float32(5), np.float32(6))), RAISE),
        (0, 4.0, 0.0, HOLD),  # no lower line at stage 0
        (1, 4.0, 3.0, HOLD),  # tie with the lower line
        (1, 4.0, float(np.nextafter(np.float32(3), np.float32(2))), LOWER),
        (1, 4.0, 1e3, HOLD),  # no upper line at the top stage
        (1, 4.0, 0.0, LOWER),
        (1, 4.0, -0.0, LOWER),
        (0, -100.0, 4.25, HOLD),  # clamped to s = 1, where the line is at 4.25
        (0, -100.0, 4.5, RAISE),
        (0, 100.0, 6.0, HOLD),  # clamped to s = 8
        (0, 100.0, 6.5, RAISE),
        (0, 4.0, 3.4e38, RAISE),  # beyond the valid speeds, but a number
    ],
)
def test_the_rule_on_a_table_that_can_be_checked_by_hand(
    linear_table: ControllerTable, stage: int, s_m: float, v_m_s: float, answer: int
) -> None:
    assert decide_for(linear_table, stage, s_m, v_m_s) == answer
    assert decide_many(linear_table, stage, s_m, v_m_s) == answer


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
    # The same reading with credible numbers does ask for a change, so that HOLD is an answer to what is incredible.
    assert decide_for(linear_table, 1, 4.0, 0.0) == LOWER
    assert decide_for(linear_table, 0, 4.0, 9.0) == RAISE
    assert decide_for(linear_table, stage, s_m, v_m_s) == HOLD
    assert decide_many(linear_table, stage, s_m, v_m_s) == HOLD


@pytest.mark.parametrize("name", ["table", "approached_table", "surface_table"])
def test_a_jump_ends_where_one_stage_after_the_other_would(name: str, request: pytest.FixtureRequest) -> None:
    """A controller that could send a command for each stage, at once and with one reading, would end there."""
    table: ControllerTable = request.getfixturevalue(name)
    far = 0
    for stage, s, v, kpa in zip(*adversarial_readings(table, np.random.default_rng(8), 4000), strict=True):
        wanted = stage_for(table, int(stage), float(s), float(v), float(kpa))
        answers = [decide_for(table, k, float(s), float(v), float(kpa)) for k in range(len(table.stages))]
        if not 0 <= stage < len(answers) or answers[stage] == HOLD:
            assert wanted == stage
            continue
        step = answers[stage]
        assert step * (wanted - stage) > 0
        assert all(answers[k] == step for k in range(stage, wanted, step))
        assert answers[wanted] != step
        far += abs(wanted - stage) > 1
    assert far > 100


def test_subnormal_coefficients_are_not_flushed_to_zero(linear_table: ControllerTable) -> None:
    tiny = float(np.float32(1e-44))
    table = replace(
        linear_table,
        stages=(Stage(0, 0.0, None, (tiny, 0.0)), Stage(1, 1.0, None, None)),
        valid=ValidRange((0.0, 1.0), (0.0, 1.0)),
    )
    compiled: Any = numba.njit(decide)
    arrays = (table.coefficients, table.has_line, table.valid_range, table.entrance_stage)
    for v, answer in ((tiny, HOLD), (float(np.nextafter(np.float32(tiny), np.float32(1))), RAISE)):
        assert decide(*arrays, 0, 0.5, v) == compiled(*arrays, 0, 0.5, v) == decide_many(table, 0, 0.5, v) == answer


def test_many_broadcasts_and_refuses_stages_that_are_no_integers(linear_table: ControllerTable) -> None:
    answers = decide_many(linear_table, [[0], [1]], 4.0, [0.0, 4.0, 9.0])
    assert answers.tolist() == [[HOLD, HOLD, RAISE], [LOWER, HOLD, HOLD]]
    assert answers.dtype == np.int8
    with pytest.raises(TypeError, match="integers"):
        decide_many(linear_table, 0.0, 4.0, 4.0)
