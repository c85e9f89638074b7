"""The rule at a passage against a plain restatement of it: how many switching speeds lie on the way."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from numba import njit

from tests.tuning_tables.passages.made_tables import row_lists, table_of
from tuning_tables.passages.rule import wanted_stage

COMPILED: Any = njit(wanted_stage)
NAN, INF = math.nan, math.inf
Speeds = npt.NDArray[np.float32]


@st.composite
def switching(draw: st.DrawFn) -> Speeds:
    """Rows of three passages, the outer ones alike, and two to five stages."""
    stages = draw(st.integers(2, 5))
    outer, inner = draw(row_lists(stages)), draw(row_lists(stages))
    return np.array([outer, inner, outer], dtype=np.float32)


def restated(row: list[float], stage: int, highest: int, v: float) -> int:
    """Up by as many stages as speeds from the stage on lie below v, else down by as many as lie above v below it."""
    up = sum(t < v for t in row[stage:highest])
    down = sum(t > v for t in row[:stage])
    assert not (up and down)
    return stage + up - down


@given(switching(), st.integers(0, 2), st.data())
@settings(derandomize=True, max_examples=120, deadline=None)
def test_the_rule_counts_the_speeds_on_the_way(speeds: Speeds, passage: int, data: st.DataObject) -> None:
    stage = data.draw(st.integers(0, speeds.shape[2]))
    known = st.sampled_from([float(t) for t in speeds[passage].ravel() if np.isfinite(t)] or [1.0])
    v = data.draw(known | st.floats(0.0, 3e38))
    entrance, before = data.draw(st.integers(0, 5)), data.draw(st.integers(0, 3))
    highest = speeds.shape[2]
    if passage < before:
        highest = max(stage, min(highest, entrance))
    wanted = restated([float(t) for t in speeds[passage, stage]], stage, highest, float(np.float32(v)))
    assert wanted_stage(speeds, entrance, before, passage, stage, v) == wanted
    assert COMPILED(speeds, entrance, before, passage, stage, v) == wanted


@given(switching(), st.integers(-2, 4), st.integers(-2, 7), st.floats(), st.integers(0, 5), st.integers(0, 3))
@settings(derandomize=True, max_examples=120, deadline=None)
@example(np.zeros((3, 2, 1), np.float32), 0, 0, 3.5e38, 0, 0)
def test_no_number_is_an_error_and_compiled_text_gives_the_same(
    speeds: Speeds, passage: int, stage: int, v: float, entrance: int, before: int
) -> None:
    wanted = wanted_stage(speeds, entrance, before, passage, stage, v)
    assert COMPILED(speeds, entrance, before, passage, stage, v) == wanted
    known = 0 <= passage < 3 and 0 <= stage <= speeds.shape[2]
    if not known or not 0.0 <= v <= float(np.finfo(np.float32).max):
        assert wanted == stage
    if known and passage < before:
        assert wanted <= max(stage, entrance)


@given(switching(), st.integers(0, 2), st.data())
@settings(derandomize=True, max_examples=80, deadline=None)
def test_the_stage_wanted_never_falls_with_the_speed(speeds: Speeds, passage: int, data: st.DataObject) -> None:
    stage = data.draw(st.integers(0, speeds.shape[2]))
    slow, fast = sorted((data.draw(st.floats(0.0, 50.0)), data.draw(st.floats(0.0, 50.0))))
    assume(slow < fast)
    wanted = [wanted_stage(speeds, 5, 0, passage, stage, v) for v in (slow, fast)]
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
    table = table_of()
    before = table.before_entrance
    assert wanted_stage(table.switching_m_s, table.entrance_stage, before, passage, stage, v) == wanted
