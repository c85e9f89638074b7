"""Tables that act before the entrance: what they must be, what they may command there, and who reads them."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tuning_tables import (
    Approach,
    ControllerTable,
    Estimator,
    InvalidTable,
    ValidRange,
    decide_for,
    decide_many,
)
from tuning_tables.active_table import active, between, interpolable

TINY = float(np.finfo(np.float32).smallest_subnormal)


def with_estimator(table: ControllerTable, *breaks: float) -> ControllerTable:
    return replace(
        table,
        estimator=Estimator(0.05, 0.15, 0.006, 0.1, 2.0, 7, 20, 0.2, 0.5, 60.0, breaks, (0.0,) * 3, (0.0, 0.0, 0.01)),
    )


@pytest.mark.requirement("RULE-07")
@pytest.mark.parametrize(
    ("stage", "s_m", "v_m_s", "answer"),
    [
        (0, -4.0, 9.0, 1),  # up to the entrance stage, and no further
        (1, -4.0, 9.0, 1),
        (0, 4.0, 9.0, 2),
        (1, -100.0, 9.0, 1),  # clamped to the beginning of the approach
        (1, -TINY, 9.0, 1),  # the last float32 number before the entrance
        (0, -TINY, 9.0, 1),
        (1, -0.0, 9.0, 2),  # at the entrance
        (1, 0.0, 9.0, 2),
        (1, -1e-60, 9.0, 2),  # -0.0 in float32
        (1, TINY, 9.0, 2),
        (1, -2.0, 0.0, 0),  # lowering is always allowed
        (3, -2.0, 0.0, 0),  # also where the interlock was broken
        (3, -2.0, 9.0, 3),
    ],
)
def test_before_the_entrance_no_stage_above_the_entrance_stage_is_commanded(
    approached_table: ControllerTable, stage: int, s_m: float, v_m_s: float, answer: int
) -> None:
    assert decide_for(approached_table, stage, s_m, v_m_s) == answer
    assert decide_many(approached_table, stage, s_m, v_m_s) == answer
    assert decide_for(active(approached_table), stage, s_m, v_m_s) == answer


def test_without_approach_the_entrance_stage_is_the_highest(table: ControllerTable) -> None:
    assert table.entrance_stage == active(table).entrance_stage == 3
    moved = replace(table, valid=ValidRange((-4.0, 37.45), (0.3, 9.0)))
    assert decide_for(moved, 1, -2.0, 9.0) == 2  # as ever: its path range begins before the entrance


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"approach": 4.0}, "approach is 4.0"),
        ({"approach": Approach(4.0, 4)}, r"entrance_stage is 4, but it must be a whole number in \[0, 3\]"),
        ({"approach": Approach(4.5, 1)}, r"valid\.s_m is .* must begin at -approach\.length_m, -4\.5"),
        ({"valid": ValidRange((0.0, 37.45), (0.3, 9.0))}, "must begin at"),
        ({"valid": ValidRange((-4.0, -0.5), (0.3, 9.0))}, "end behind the entrance"),
    ],
    ids=repr,
)
def test_an_approach_that_does_not_fit_its_table_is_refused(
    approached_table: ControllerTable, change: dict[str, object], reason: str
) -> None:
    with pytest.raises(InvalidTable, match=reason):
        replace(approached_table, **change)  # type: ignore[arg-type]  # one of the values has a wrong type


def test_the_estimator_of_an_approach_begins_with_it(approached_table: ControllerTable) -> None:
    assert with_estimator(approached_table, -4.0, 0.0, 12.0).estimator is not None
    with pytest.raises(InvalidTable, match=r"breaks must begin at -approach\.length_m"):
        with_estimator(approached_table, -3.9, 0.0, 12.0)


@pytest.mark.parametrize(
    ("length_m", "stage"), [(0.0, 1), (-4.0, 1), (1e-4, 1), (100.5, 1), (float("nan"), 1), (4.0, -1), (4.0, 1.0)]
)
def test_a_wrong_approach_is_refused(length_m: float, stage: Any) -> None:
    with pytest.raises(InvalidTable, match="approach"):
        Approach(length_m, stage)


def test_lines_are_taken_between_equal_approaches_only(approached_table: ControllerTable) -> None:
    faster = replace(approached_table, id="faster", target_speed_m_s=5.0)
    assert interpolable(approached_table, faster)
    assert between(approached_table, faster, np.float32(4.5)).entrance_stage == 1
    assert not interpolable(approached_table, replace(faster, approach=Approach(4.0, 2)))
    assert not interpolable(approached_table, replace(faster, approach=None))
    longer = replace(faster, approach=Approach(4.5, 1), valid=ValidRange((-4.5, 37.45), (0.3, 9.0)))
    assert not interpolable(approached_table, longer)
