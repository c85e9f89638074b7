"""Golden vectors show a controller whose jump over stages is wrong."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from tuning_tables import ControllerTable, Decisions, decide_for, decide_many
from tuning_tables.golden_vectors import GoldenVectors, few_golden_vectors, golden_vectors


def followed(table: ControllerTable, golden: GoldenVectors, ends: Callable[[int, int], bool]) -> list[int]:
    """Where a rule ends that goes on until an answer and the one before it at which it `ends`."""
    once = replace(table, decisions=Decisions.AT_ANY_TIME)
    found = []
    for stage, s, v in zip(golden.stage.tolist(), golden.s_m, golden.v_m_s, strict=True):
        reached, before = stage, 0
        for _ in range(table.farthest):
            step = decide_for(once, reached, s, v) - reached
            if ends(step, before):
                break
            reached, before = reached + step, step
        found.append(reached)
    return found


OTHER_RULES: dict[str, Callable[[int, int], bool]] = {
    "the rule": lambda step, before: step in (0, -before),
    "one stage": lambda step, before: before != 0,
    "on after the opposite answer": lambda step, before: step == 0,
}


@pytest.mark.parametrize("rule", OTHER_RULES)
@pytest.mark.parametrize("vectors", [golden_vectors, few_golden_vectors])
@pytest.mark.parametrize("stages", [4, 5])
def test_the_golden_vectors_show_a_wrong_jump(
    turning_table: ControllerTable, stages: int, vectors: Callable[[ControllerTable], GoldenVectors], rule: str
) -> None:
    """With an odd number of stages to go, one that turns back and forth may end at the right one by chance."""
    kept = turning_table.stages[:stages]
    table = replace(turning_table, stages=(*kept[:-1], replace(kept[-1], upper=None)))
    golden = vectors(table)
    assert np.count_nonzero(abs(golden.answer - golden.stage) > 1) > 4
    assert (followed(table, golden, OTHER_RULES[rule]) == golden.answer.tolist()) == (rule == "the rule")


@pytest.mark.parametrize("vectors", [golden_vectors, few_golden_vectors])
def test_the_golden_vectors_show_a_jump_at_any_time(
    turning_table: ControllerTable, vectors: Callable[[ControllerTable], GoldenVectors]
) -> None:
    golden = vectors(replace(turning_table, decisions=Decisions.AT_ANY_TIME))
    jumping = decide_many(turning_table, golden.stage, golden.s_m, golden.v_m_s)
    assert np.count_nonzero(jumping != golden.answer) > 5
    assert np.all(abs(golden.answer - golden.stage) <= 1)
