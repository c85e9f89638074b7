"""The rule at a passage against a plain restatement of it: how many switching speeds lie on the way."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from synth.kernels.compiled_rules import compiled_rule
from tests.effort import sized
from tests.tuning_tables.passages.made_tables import row_lists, table_of
from tuning_tables.passages.held_passages import held_by, held_passages
from tuning_tables.programs.at_pulse import wanted_stage
from tuning_tables.programs.passage_table import HeldPassages

COMPILED: Any = compiled_rule(wanted_stage)
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
    assert COMPILED(table, passage, stage, v) == wanted


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
    assert COMPILED(table, passage, stage, v) == wanted
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
