"""The rule at a passage against a plain restatement, and the step at a pulse pair, for every input; compiled, the
same.
"""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from synth.kernels.compiled_rules import compiled_rule
from tests.controller_code.passage_tables import passage_table, passage_tables
from tests.effort import sized
from tests.tuning_tables.passages.made_tables import row_lists, table_of
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.rule import held_by, held_passages
from tuning_tables.programs.at_pulse import at_pulse, wanted_stage
from tuning_tables.programs.held import NONE, HeldPassages
from tuning_tables.programs.tracker import LONGEST_WAIT_S, begin_cut, believed_passage

COMPILED_RULE: Any = compiled_rule(wanted_stage)
NOTHING = np.zeros(0)
NAN, INF = math.nan, math.inf
Speeds = npt.NDArray[np.float32]


@st.composite
def switching(draw: st.DrawFn) -> Speeds:
    """Rows of three passages, the outer ones alike, and two to five stages."""
    stages = draw(st.integers(2, 5))
    outer, inner = draw(row_lists(stages)), draw(row_lists(stages))
    return np.array([outer, inner, outer], dtype=np.float32)


def deciding(speeds: Speeds, entrance: int, before: int) -> HeldPassages:
    """A table with these switching speeds that hears nothing."""
    nobody = NOTHING.astype(np.int64)
    return held_passages(speeds, NOTHING, nobody, nobody, np.zeros(6), entrance_stage=entrance, before_entrance=before)


def restated(row: list[float], stage: int, highest: int, v: float) -> int:
    """Up by as many stages as speeds from the stage on lie below v, else down by as many as lie above v below it."""
    up = sum(t < v for t in row[stage:highest])
    down = sum(t > v for t in row[:stage])
    assert not (up and down)
    return stage + up - down


@pytest.mark.requirement("PASS-01")
@given(switching(), st.integers(0, 2), st.data())
@settings(derandomize=True, max_examples=sized(30, 120), deadline=None)
def test_the_rule_counts_the_speeds_on_the_way(speeds: Speeds, passage: int, data: st.DataObject) -> None:
    stage = data.draw(st.integers(0, speeds.shape[2]))
    known = st.sampled_from([float(t) for t in speeds[passage].ravel() if np.isfinite(t)] or [1.0])
    v = np.float32(data.draw(known | st.floats(0.0, 3e38)))
    entrance, before = data.draw(st.integers(0, 5)), data.draw(st.integers(0, 3))
    highest = speeds.shape[2]
    if passage < before:
        highest = max(stage, min(highest, entrance))
    wanted = restated([float(t) for t in speeds[passage, stage]], stage, highest, float(v))
    table = deciding(speeds, entrance, before)
    assert wanted_stage(table, passage, stage, v) == wanted
    assert COMPILED_RULE(table, passage, stage, v) == wanted


@pytest.mark.requirement("RULE-07")
@given(switching(), st.integers(-2, 4), st.integers(-2, 7), st.floats(), st.integers(0, 5), st.integers(0, 3))
@settings(derandomize=True, max_examples=sized(30, 120), deadline=None)
@example(np.zeros((3, 2, 1), np.float32), 0, 0, 3.5e38, 0, 0)
def test_no_number_is_an_error_and_compiled_text_gives_the_same(
    speeds: Speeds, passage: int, stage: int, told: float, entrance: int, before: int
) -> None:
    table = deciding(speeds, entrance, before)
    with np.errstate(over="ignore"):
        v = np.float32(told)
    wanted = wanted_stage(table, passage, stage, v)
    assert COMPILED_RULE(table, passage, stage, v) == wanted
    known = 0 <= passage < 3 and 0 <= stage <= speeds.shape[2]
    if not known or not 0.0 <= v <= float(np.finfo(np.float32).max):
        assert wanted == stage
    if known and passage < before:
        assert wanted <= max(stage, entrance)


@pytest.mark.requirement("PASS-02")
@given(switching(), st.integers(0, 2), st.data())
@settings(derandomize=True, max_examples=sized(20, 80), deadline=None)
def test_the_stage_wanted_never_falls_with_the_speed(speeds: Speeds, passage: int, data: st.DataObject) -> None:
    stage = data.draw(st.integers(0, speeds.shape[2]))
    slow, fast = sorted((data.draw(st.floats(0.0, 50.0)), data.draw(st.floats(0.0, 50.0))))
    assume(slow < fast)
    wanted = [wanted_stage(deciding(speeds, 5, 0), passage, stage, v) for v in (slow, fast)]
    assert wanted[0] <= wanted[1]


@pytest.mark.parametrize(
    ("passage", "stage", "v", "wanted"),
    [
        (1, 0, 5.0, 0),
        (1, 0, 5.001, 1),
        (1, 0, 9.0, 1),
        (1, 1, 4.5, 1),
        (1, 1, 4.499, 0),
        (1, 1, 6.26, 2),
        (0, 1, 6.26, 1),
        (1, 2, 0.0, 1),
        (0, 2, 9.0, 2),
        (1, 1, NAN, 1),
        (1, 1, INF, 1),
        (1, 1, -0.1, 1),
        (9, 1, 9.0, 1),
        (-1, 1, 9.0, 1),
        (1, 3, 9.0, 3),
    ],
)
def test_decisions_of_a_table_by_hand(passage: int, stage: int, v: float, wanted: int) -> None:
    assert wanted_stage(held_by(table_of()), passage, stage, v) == wanted


TABLES = passage_tables()
WORDS = st.integers(0, 2**32 - 1)
NUMBERS = st.floats(width=32) | WORDS.map(lambda bits: float(np.array(bits, np.uint32).view(np.float32)))
STATES = st.lists(NUMBERS | st.sampled_from([-1.0, 0.0, 1.0, 5.0]), min_size=6, max_size=6)
TIMES = st.floats(0.0, 5.0) | NUMBERS | st.floats()
COUNTS = st.integers(-3, 40) | st.sampled_from([-(2**31), 2**31 - 1])


def begun() -> npt.NDArray[np.float32]:
    state = np.zeros(6, dtype=np.float32)
    begin_cut(state)
    return state


def state_of(values: list[float]) -> npt.NDArray[np.float32]:
    with np.errstate(all="ignore"):
        return np.array(values, dtype=np.float32)


COMPILED_STEP: Any = compiled_rule(at_pulse)


def first_over(table: PassageTable, sensor: int) -> int:
    """The passage of the first axle over `sensor`, as the tracker numbers passages."""
    return int(np.flatnonzero(table.heard_sensor == sensor)[0])


def pulse(table: PassageTable, state: npt.NDArray[np.float32], sensor: int, since_s: float, v_m_s: float) -> int:
    """The stage after a pair of a cut at v_m_s while stage 2 is in force and at rest."""
    return int(at_pulse(held_by(table), state, sensor, since_s, 0.2 / v_m_s, 2, True))


def test_a_believed_pair_is_decided_by_its_row() -> None:
    table, state = TABLES[0], begun()
    fast, slow = 9.0, 1.0
    assert pulse(table, state, 0, 3.0, fast) == 2  # before the entrance no stage above the entrance stage, 2
    assert state.tolist() == [0.0, np.float32(np.float32(0.2) / np.float32(0.2 / fast)), 0.0, -1.0, 0.0, 3.0]
    assert pulse(table, state, 1, 6.0 / fast, fast) == 3  # its row never raises to the top
    assert pulse(table, begun(), 3, 1.0, fast) == 4
    assert pulse(table, begun(), 3, 1.0, slow) == 0
    assert pulse(table, begun(), 6, 1.0, slow) == 2  # behind the exit nothing is decided


@pytest.mark.requirement("PASS-03")
def test_an_unfinished_change_commands_nothing_but_the_pair_is_known() -> None:
    held, state = held_by(TABLES[0]), begun()
    assert at_pulse(held, state, 3, 1.0, 0.2 / 9.0, 2, False) == 2
    assert state[0] == first_over(TABLES[0], 3)
    assert at_pulse(held, state, 4, 7.25 / 9.0, 0.2 / 9.0, 2, True) == 3
    assert state[0] == first_over(TABLES[0], 4)


@pytest.mark.requirement("PASS-03")
@pytest.mark.parametrize("over_base_s", [np.nan, np.inf, -0.1, 0.0, 2.0**-21, 2e6, 1e300, -1e300, 1.0, 0.01])
def test_a_reading_that_cannot_be_is_a_pair_that_is_not_believed(over_base_s: float) -> None:
    state = begun()
    for since_s in (0.5, 0.25):
        with np.errstate(over="ignore"):
            assert at_pulse(held_by(TABLES[0]), state, 3, since_s, over_base_s, 2, True) == 2
    assert state.tolist() == [-1.0, 0.0, 0.75, -1.0, 0.0, 0.75]


@settings(max_examples=sized(100, 400))
@given(st.sampled_from(TABLES), STATES, COUNTS, TIMES, TIMES, COUNTS, st.booleans())
def test_for_every_input_the_step_is_its_parts_and_compiled_the_same(
    table: PassageTable, values: list[float], sensor: int, since_s: float, over_s: float, stage: int, ended: bool
) -> None:
    held, state = held_by(table), state_of(values)
    other, third = state.copy(), state.copy()
    with np.errstate(over="ignore"):
        given_s = np.float32(since_s), np.float32(over_s)
    with np.errstate(over="raise", invalid="raise"):
        answer = at_pulse(held, state, sensor, *given_s, stage, ended)
        v = np.float32(-1.0)
        if 2.0**-20 <= float(given_s[1]) <= 1e6:
            v = np.float32(table.sensors.base_m) / given_s[1]
        heard = believed_passage(held, other, sensor, given_s[0], v)
        passage = -1 if heard < 0 else int(table.heard_passage[heard])
        wanted = wanted_stage(held, passage, stage, v)
    assert answer == (wanted if ended else stage)
    assert COMPILED_STEP(held, third, sensor, *given_s, stage, ended) == answer
    for found in (other, third):
        assert np.array_equal(found.view(np.uint32), state.view(np.uint32))
    # Whatever it was, the state is one that can be.
    for half in (state[:3], state[3:]):
        assert half[0] in range(-1, len(table.heard_path_m))
        assert 0.0 <= half[1] <= table.limits[1]
        assert 0.0 <= half[2] <= LONGEST_WAIT_S


@pytest.mark.requirement("PASS-06")
@pytest.mark.parametrize(
    ("place", "value"),
    [*itertools.product(range(6), (np.nan, np.inf, -2.0, 3e38)), (0, 0.5), (3, 0.5), (3, 2.000001)],
)
def test_a_state_that_cannot_be_is_begun_anew(place: int, value: float) -> None:
    table, state = passage_table(), state_of([2.0, 5.0, 0.1, 1.0, 4.0, 0.2])
    state[place] = value
    first = first_over(table, 4)
    assert believed_passage(held_by(table), state, 4, 0.5, 3.0) == first
    assert state.tolist() == [first, 3.0, 0.0, -1.0, 0.0, 0.5]


def test_times_are_bounded_however_long_nothing_comes() -> None:
    table, state = held_by(passage_table()), begun()
    for _ in range(3):
        assert believed_passage(table, state, 9, LONGEST_WAIT_S, 3.0) == NONE
    assert state[2] == state[5] == LONGEST_WAIT_S
