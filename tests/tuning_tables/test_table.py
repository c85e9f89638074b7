"""A controller table is complete and consistent, or does not exist; what those that act before the entrance may
command.
"""

import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.effort import sized
from tuning_tables import (
    Approach,
    ControllerTable,
    CutId,
    Estimator,
    Generator,
    InvalidTable,
    RetarderId,
    Stage,
    Validated,
    ValidRange,
    decide_for,
    decide_many,
)
from tuning_tables.active_table import active, between, interpolable
from tuning_tables.stage import Line, round_coefficients

Crossing = Callable[[Line, Line, tuple[float, float]], ControllerTable]

NAN, INF = float("nan"), float("inf")


def test_arrays_hold_the_lines_and_are_read_only(table: ControllerTable) -> None:
    assert table.coefficients.shape == (4, 2, 4)
    assert table.coefficients.dtype == np.float32
    assert table.has_line.tolist() == [[False, True], [True, True], [True, False], [True, False]]
    assert tuple(table.coefficients[1, 0].tolist()) == table.stages[1].lower
    assert tuple(table.coefficients[1, 1].tolist()) == table.stages[1].upper
    assert np.array_equal(np.isnan(table.coefficients).all(axis=2), ~table.has_line)
    assert table.valid_range.tolist() == [0.0, float(np.float32(37.45)), float(np.float32(0.3)), 9.0]
    for array in (table.coefficients, table.has_line, table.valid_range):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 1


def test_a_table_is_a_value(table: ControllerTable) -> None:
    twin = replace(table)
    assert twin == table
    assert hash(twin) == hash(table)
    copy = pickle.loads(pickle.dumps(table))
    assert copy == table
    assert np.array_equal(copy.coefficients, table.coefficients, equal_nan=True)
    with pytest.raises(FrozenInstanceError):
        table.id = "other"  # type: ignore[misc]  # the very thing that is refused


def test_validated_is_filled_in_on_a_copy(linear_table: ControllerTable) -> None:
    validated = Validated(100, 0.1, (0.08, 0.12))
    assert linear_table.with_validated(validated).validated == validated
    assert linear_table.validated is None


@pytest.mark.parametrize(
    "change",
    [
        {"id": "half \ud800 a pair"},
        {"created": "2026-11-20 22:46"},
        {"created": "2026-11-20T22:46:00Z\n"},
        {"generator": None},
        {"target_speed_m_s": True},
        {"degree": 2},
        {"degree": True},
        {"stages": ()},
        {"stages": []},
        {"valid": (0.0, 1.0)},
        {"predicted": None},
        {"validated": 0.05},
    ],
    ids=repr,
)
def test_a_wrong_field_is_refused_by_name(table: ControllerTable, change: dict[str, object]) -> None:
    key = {"degree": "(degree|coefficients)"}.get(next(iter(change)), next(iter(change)))
    with pytest.raises(InvalidTable, match=key):
        replace(table, **change)  # type: ignore[arg-type]  # one of the values has a wrong type


@pytest.mark.parametrize(
    "stages",
    [
        (Stage(0, 0.0, None, (4.0,)),),
        (Stage(0, 0.0, None, (4.0,)), Stage(2, 100.0, (2.0,), None)),
        (Stage(1, 0.0, None, (4.0,)), Stage(2, 100.0, (2.0,), None)),
        (Stage(0, 0.0, None, (4.0,)), Stage(1, 0.0, (2.0,), None)),
        (Stage(0, 0.0, (1.0,), (4.0,)), Stage(1, 100.0, (2.0,), None)),
        (Stage(0, 0.0, None, (4.0,)), Stage(1, 100.0, (2.0,), (4.0,))),
        (Stage(0, 0.0, None, (4.0, 0.0)), Stage(1, 100.0, (2.0,), None)),
        (Stage(0, 0.0, None, (2.0**127,)), Stage(1, 100.0, (2.0,), None)),
        (*(Stage(k, 10.0 * k, None, None) for k in range(32)), Stage(31, 320.0, None, None)),
        (None, None),
    ],
)
def test_wrong_stages_are_refused(linear_table: ControllerTable, stages: tuple[Stage | None, ...]) -> None:
    with pytest.raises(InvalidTable, match="stage"):
        replace(linear_table, degree=0, stages=stages)  # type: ignore[arg-type]  # None is no stage


@pytest.mark.parametrize(
    ("make", "key"),
    [
        (lambda: Stage(0, 0.0, None, [4.0]), "upper"),  # type: ignore[arg-type]  # a list
        (lambda: Stage(0, 0.0, None, (NAN,)), "upper"),
        (lambda: Stage(0, 0.0, None, ()), r"upper has 0 entries, but 1 to 10 are allowed"),
        (lambda: Stage(0, 0.0, None, (0.1,)), "round_coefficients"),
        (lambda: Stage(0, 0.0, None, (1e39,)), "float32"),
        (lambda: round_coefficients([1.0, 1e39]), "coefficient 1"),
        (lambda: round_coefficients([NAN]), "coefficient 0"),
        (lambda: Generator("g", "1", "0" * 64 + "\n"), "config_sha256"),
        (lambda: RetarderId("r", (), 1.0, 1.0), "zones_m"),
        (lambda: RetarderId("r", ((2.0, 1.0),), 3.0, 1.0), "zones_m"),
        (lambda: RetarderId("r", ((0.0, 2.0), (1.0, 3.0)), 3.0, 1.0), "zones_m"),
        (lambda: RetarderId("r", ((0.0, 2.0),), 1.0, 1.0), "exit_m"),
        (lambda: CutId("c", 1.0, ()), "axle_offsets_m"),
        (lambda: CutId("c", 1.0, (0.0, 0.0)), "axle_offsets_m"),
        (lambda: CutId("c", 1.0, (1.0, 2.0)), "axle_offsets_m"),
        (lambda: ValidRange((1.0, 1.0), (0.0, 1.0)), "valid.s_m"),
        (lambda: ValidRange((1.0, 1.0 + 1e-9), (0.0, 1.0)), "valid.s_m is .* at least 0.001 apart"),
        (lambda: ValidRange((0.0, 1.0), (1.0, 1.0009)), "valid.v_m_s is .* at least 0.001 apart"),
        (lambda: ValidRange((-0.0, 1.0), (0.0, 1.0)), "valid.s_m.0. is -0.0"),
        (lambda: Stage(0, 0.0, None, (1.0, -0.0)), "upper.1. is -0.0"),
        (lambda: CutId("c", 10**400, (0.0,)), "mass_t is 1000"),
        (lambda: ValidRange((0.0, 1e7), (0.0, 1.0)), "valid.s_m"),
        (lambda: Validated(1.0, 0.1, (0.0, 0.2)), "passes"),  # type: ignore[arg-type]  # not a whole number
        (lambda: Validated(1, 0.1, (0.2, 0.1)), "ci95"),
        (lambda: Validated(1, 0.1, (0.1,)), "ci95"),  # type: ignore[arg-type]  # half an interval
    ],
)
def test_wrong_parts_are_refused_by_name(make: Callable[[], object], key: str) -> None:
    with pytest.raises(InvalidTable, match=key):
        make()


@given(st.floats(width=64, allow_nan=False, min_value=-3e38, max_value=3e38))
@settings(derandomize=True)
def test_rounding_gives_the_nearest_float32(value: float) -> None:
    (rounded,) = round_coefficients([value])
    error = abs(rounded - value)
    neighbours = [np.nextafter(np.float32(rounded), np.float32(side)) for side in (-np.inf, np.inf)]
    assert all(error <= abs(float(neighbour) - value) for neighbour in neighbours)
    assert round_coefficients([rounded]) == (rounded,)


@pytest.mark.requirement("RULE-06")
@pytest.mark.parametrize(
    ("lower", "upper", "s_m", "accepted"),
    [
        ((1.0,), (2.0,), (0.0, 10.0), True),
        ((2.0,), (2.0,), (0.0, 10.0), False),
        ((3.0,), (2.0,), (0.0, 10.0), False),
        # They cross at s = 5: within the range, and just beyond it.
        ((0.0, 1.0), (5.0, 0.0), (0.0, 10.0), False),
        ((0.0, 1.0), (5.0, 0.0), (0.0, 4.75), True),
        # gap (s - 5)^2 + 1/4: never below 1/4, though its chord and ends tell nothing of it
        ((0.0, 0.0, 0.0), (25.25, -10.0, 1.0), (0.0, 10.0), True),
        # gap (s - 5)^2 - 1/4: below zero only for 4.5 < s < 5.5
        ((0.0, 0.0, 0.0), (24.75, -10.0, 1.0), (0.0, 10.0), False),
        # gap (s - 5)^2: touches
        ((0.0, 0.0, 0.0), (25.0, -10.0, 1.0), (0.0, 10.0), False),
        # gap 2^-20 m/s between lines of 1000 m/s: float32 cannot tell them apart at every s
        ((1000.0, 1.0), (1000.0 + 2.0**-13, 1.0), (0.0, 10.0), False),
        ((1000.0, 0.0), (1000.0 + 2.0**-7, 0.0), (0.0, 10.0), True),
    ],
)
def test_lines_must_keep_their_order_on_the_whole_range(
    crossing: Crossing, lower: Line, upper: Line, s_m: tuple[float, float], accepted: bool
) -> None:
    if accepted:
        assert crossing(lower, upper, s_m).stages[1].lower == lower
    else:
        with pytest.raises(InvalidTable, match=r"stages\[1\]: upper - lower"):
            crossing(lower, upper, s_m)


coefficients = st.floats(-8, 8, width=32).map(lambda c: c + 0.0)  # no -0.0


@pytest.mark.requirement("RULE-06")
@given(
    lower=st.lists(coefficients, min_size=3, max_size=6),
    offset=st.floats(0, 2.0**-14, width=32),
    seed=st.integers(0, 2**32 - 1),
)
@settings(derandomize=True, max_examples=sized(50, 200), deadline=None)
def test_accepted_lines_never_cross_in_float32(
    crossing: Crossing, lower: list[float], offset: float, seed: int
) -> None:
    upper = round_coefficients([lower[0] + offset, *lower[1:]])
    try:
        table = crossing(tuple(lower), upper, (-1.5, 2.0))
    except InvalidTable:
        assume(False)
    s = np.random.default_rng(seed).uniform(-1.5, 2.0, 2000).astype(np.float32)
    speeds = table.coefficients[1, :, -1][:, np.newaxis]
    for power in range(table.degree - 1, -1, -1):
        speeds = speeds * s + table.coefficients[1, :, power][:, np.newaxis]
    assert np.all(speeds[0] < speeds[1])


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
