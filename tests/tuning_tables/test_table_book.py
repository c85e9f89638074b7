"""The choice of a table in a book, and the lines between two of them."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.tuning_tables.passages.made_tables import table_of
from tuning_tables import ControllerTable, CutId, InvalidTable, Stage, decide_for
from tuning_tables.active_table import active, between
from tuning_tables.golden_vectors import line_speeds
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.programs.decide import decide
from tuning_tables.stage import round_coefficients
from tuning_tables.table_book import Choice, Status, TableBook

EIGHT = tuple(float(x) for x in range(8))


def moved(table: ControllerTable, target: float, by: float = 0.0, **changes: Any) -> ControllerTable:
    """`table` for another target, its lines moved by the difference, and by `by` in every power."""
    stages = tuple(
        replace(stage, lower=_moved(stage.lower, target - 4.0, by), upper=_moved(stage.upper, target - 4.0, by))
        for stage in table.stages
    )
    return replace(table, id=f"to-{target}", target_speed_m_s=target, stages=stages, **changes)


def _moved(line: tuple[float, ...] | None, up: float, by: float) -> tuple[float, ...] | None:
    return None if line is None else round_coefficients([line[0] + up, *(c * (1.0 + by) for c in line[1:])])


@pytest.fixture(scope="module")
def book(table: ControllerTable) -> TableBook:
    """Targets 4, 2 and 3 m/s of one class, out of order."""
    return TableBook((moved(table, 4.0), moved(table, 2.0, 0.3), moved(table, 3.0, -0.2)))


def chosen(book: TableBook, speed: float) -> Choice:
    return book.choose("medium", 4, speed)


@pytest.mark.requirement("CHOICE-01", "CHOICE-02")
@pytest.mark.parametrize(
    ("speed", "status", "numbers"),
    [
        (2.0, Status.TUNED, (1,)),
        (3.0, Status.TUNED, (2,)),
        (4.0, Status.TUNED, (0,)),
        (2.5, Status.BETWEEN, (1, 2)),
        (3.999, Status.BETWEEN, (2, 0)),
        (np.nextafter(np.float32(2.0), np.float32(3.0)), Status.BETWEEN, (1, 2)),
        (4.1, Status.SLOWER, (0,)),
        (3.4e38, Status.SLOWER, (0,)),
        (np.nextafter(np.float32(2.0), np.float32(1.0)), Status.NO_TARGET, ()),
        (1.0, Status.NO_TARGET, ()),
        (0.0, Status.NO_TARGET, ()),
        (-3.0, Status.NO_TARGET, ()),
        (np.nan, Status.NO_TARGET, ()),
        (np.inf, Status.NO_TARGET, ()),
        (1e39, Status.NO_TARGET, ()),
    ],
)
def test_the_rules_of_the_choice(book: TableBook, speed: float, status: Status, numbers: tuple[int, ...]) -> None:
    choice = chosen(book, speed)
    assert (choice.status, choice.numbers) == (status, numbers)
    assert (choice.table is None) == (status < 0)
    if choice.table is not None:
        assert choice.table.target_speed_m_s <= np.float32(speed)


@pytest.mark.requirement("CHOICE-02")
def test_a_class_that_the_book_lacks(book: TableBook) -> None:
    assert book.choose("heavy", 4, 3.0) == Choice(Status.NO_CLASS, None, ())
    assert book.choose("medium", 6, 3.0).status is Status.NO_CLASS
    assert book.choose("heavy", 4, np.nan).status is Status.NO_CLASS


def test_a_target_is_met_by_its_table_bit_by_bit(book: TableBook) -> None:
    choice = chosen(book, 3.0)
    assert choice.table is not None
    assert np.array_equal(choice.table.coefficients, book.tables[2].coefficients, equal_nan=True)


@pytest.mark.requirement("CHOICE-05")
@given(
    part=st.floats(0.0, 1.0, exclude_min=True, exclude_max=True), place=st.floats(0.0, 37.45), line=st.integers(0, 1)
)
def test_lines_between_lie_between_and_keep_their_order(book: TableBook, part: float, place: float, line: int) -> None:
    target = np.float32(2.0 + part)
    assume(2.0 < target < 3.0)
    choice = chosen(book, float(target))
    assert choice.table is not None
    s = np.array([place], np.float32)
    slower, faster = (book.tables[number] for number in choice.numbers)
    for k in range(4):
        if choice.table.has_line[k, line]:
            ends = [float(line_speeds(t.coefficients[k, line], s)[0]) for t in (slower, faster)]
            speed = float(line_speeds(choice.table.coefficients[k, line], s)[0])
            assert min(ends) - 1e-5 <= speed <= max(ends) + 1e-5
            weight = (float(target) - 2.0) / 1.0
            assert speed == pytest.approx((1.0 - weight) * ends[0] + weight * ends[1], abs=1e-5)
        if choice.table.has_line[k].all():
            low, high = (line_speeds(choice.table.coefficients[k, i], s)[0] for i in (0, 1))
            assert low < high


def test_lines_between_are_computed_in_float32_one_rounding_an_operation(book: TableBook) -> None:
    choice = chosen(book, 2.3)
    assert choice.table is not None
    slower, faster = (book.tables[number].coefficients[1, 0, 2] for number in choice.numbers)
    weight = np.float32(float(np.float32(2.3)) - 2.0)  # exact: 2.3 and 2 are within a factor of two
    rise = np.float32(float(faster) - float(slower))
    expected = np.float32(float(slower) + float(np.float32(float(weight) * float(rise))))
    assert choice.table.coefficients[1, 0, 2] == expected


def test_a_chosen_table_is_what_the_rule_takes(book: TableBook) -> None:
    choice = chosen(book, 2.5)
    assert choice.table is not None
    assert decide(choice.table.held, 0, 37.0, 9.0, np.nan) == decide_for(choice.table, 0, 37.0, 9.0) == 2
    with pytest.raises(ValueError, match="read-only"):
        choice.table.coefficients[0, 0, 0] = 1.0


@pytest.mark.requirement("CHOICE-04")
@pytest.mark.parametrize("change", ["degree", "stages", "lines", "range"])
def test_tables_that_differ_in_kind_are_not_mixed(table: ControllerTable, change: str) -> None:
    slower, faster = moved(table, 2.0), moved(table, 4.0)
    if change == "degree":
        stages = tuple(
            replace(s, lower=s.lower and s.lower[:3], upper=s.upper and s.upper[:3]) for s in faster.stages
        )  # fmt: skip
        faster = replace(faster, degree=2, stages=stages)
    elif change == "stages":
        faster = replace(faster, stages=faster.stages[:3])
    elif change == "lines":
        faster = replace(faster, stages=(*faster.stages[:1], replace(faster.stages[1], upper=None), *faster.stages[2:]))
    else:
        faster = replace(faster, valid=replace(faster.valid, s_m=(0.0, 38.0)))
    choice = TableBook((slower, faster)).choose("medium", 4, 3.0)
    assert (choice.status, choice.numbers) == (Status.SLOWER, (0,))


@pytest.mark.requirement("CHOICE-03")
def test_of_several_masses_the_heaviest_is_taken_and_the_others_are_named(table: ControllerTable) -> None:
    heavy = CutId("medium", 30.0, (0.0, 1.85, 8.65, 10.5))
    tables = (moved(table, 2.0), moved(table, 4.0), *(moved(table, v, cut=heavy) for v in (3.0, 5.0)))
    tables = (*tables[:3], replace(tables[3], id="b"), replace(tables[3], id="again"))
    book = TableBook(tables)
    assert book.candidates("medium", 4) == (2, 3)
    assert [each.id for each in book.shadowed()] == ["to-2.0", "to-4.0", "again"]
    assert book.choose("medium", 4, 2.5).status is Status.NO_TARGET
    other = CutId("medium", 99.0, EIGHT)
    assert TableBook((*tables, replace(tables[0], id="c", cut=other))).candidates("medium", 8) == (5,)


def test_a_book_that_is_none_is_refused(table: ControllerTable) -> None:
    with pytest.raises(InvalidTable, match="at least one table"):
        TableBook(())
    with pytest.raises(InvalidTable, match="given to 2 tables"):
        TableBook((table, table))
    with pytest.raises(InvalidTable, match="serves one position"):
        TableBook((table, replace(table, id="x", retarder=replace(table.retarder, dead_band_kpa=16.0))))
    # A longer cut leaves later: the same position all the same.
    longer = replace(table, id="x", retarder=replace(table.retarder, exit_m=40.0), cut=replace(table.cut, category="T"))
    assert len(TableBook((table, longer)).tables) == 2


@pytest.mark.parametrize("value", [1e39, 1e300, 1e-39])
def test_numbers_that_no_controller_can_hold_are_refused(table: ControllerTable, value: float) -> None:
    with pytest.raises(InvalidTable, match=r"target_speed_m_s of leer-22t-4\.0 is"):
        TableBook((replace(table, target_speed_m_s=value),))
    with pytest.raises(InvalidTable, match=r"cut\.mass_t of leer-22t-4\.0 is"):
        TableBook((replace(table, cut=replace(table.cut, mass_t=value)),))


@pytest.mark.requirement("CHOICE-05")
@pytest.mark.parametrize("steps", [(2, 2), (2, 9999), (9999, 2)])
def test_lines_too_near_to_be_interpolated_are_refused(table: ControllerTable, steps: tuple[int, int]) -> None:
    """One narrow gap is enough, whichever table has it; and what is needed covers three roundings of a number."""

    def thin(target: float, steps: int) -> ControllerTable:
        low, high = target + 1.0, float(np.float32(target + 1.0 + steps * 2.0**-22))  # float32 steps from 2 to 4
        stages = (Stage(0, 0.0, None, (9.0,)), Stage(1, 1.0, (low,), (high,)), Stage(2, 2.0, (low,), None))
        return replace(table, id=f"thin-{target:g}", target_speed_m_s=target, degree=0, stages=stages)

    tables = tuple(thin(target, each) for target, each in zip((1.0, 2.0), steps, strict=True))
    assert [TableBook((each,)).tables for each in tables] == [(each,) for each in tables]
    with pytest.raises(InvalidTable, match="the lines between thin-1 and thin-2 come within") as refused:
        TableBook(tables)
    sizes = sum(abs(line[0]) for each in tables for line in each.stages[1].lines if line)
    needed = float(str(refused.value).split("must stay ")[1].split()[0])
    assert 3.0 * 2.0**-24 * sizes <= needed <= 6.0 * 2.0**-24 * sizes


@given(slower=st.floats(0.5, 8.0), step=st.floats(0.01, 3.0), part=st.floats(0.0, 1.0), work=st.floats(0.0, 200.0))
def test_the_stated_error_of_the_choice_holds(slower: float, step: float, part: float, work: float) -> None:
    """V = sqrt(T^2 + 2 A): lines between two targets are too high by 0 to h^2 / (12 sqrt(3) T0)."""
    speeds = [np.sqrt(target**2 + 2.0 * work) for target in (slower, slower + step, slower + part * step)]
    excess = (1.0 - part) * speeds[0] + part * speeds[1] - speeds[2]
    assert -1e-12 <= excess <= step**2 / (12.0 * np.sqrt(3.0) * slower) + 1e-12


def test_the_stated_error_is_nearly_reached() -> None:
    """The bound is no idle one: a small step at A = T^2 comes within a few per cent."""
    speeds = [np.sqrt(target**2 + 2.0 * 4.0) for target in (2.0, 2.1, 2.05)]
    excess = 0.5 * (speeds[0] + speeds[1]) - speeds[2]
    assert excess > 0.95 * 0.1**2 / (12.0 * np.sqrt(3.0) * 2.0)


def test_the_ends_of_an_interpolation(table: ControllerTable) -> None:
    slower, faster = moved(table, 2.0), moved(table, 3.0, 0.1)
    assert np.array_equal(
        between(slower, faster, np.float32(2.0)).coefficients, active(slower).coefficients, equal_nan=True
    )
    assert np.allclose(
        between(slower, faster, np.float32(3.0)).coefficients, active(faster).coefficients, rtol=1e-6, equal_nan=True
    )


@pytest.mark.parametrize("through", [lambda book: pickle.loads(pickle.dumps(book)), copy.deepcopy])
def test_a_book_that_was_asked_goes_to_another_process(
    book: TableBook, through: Callable[[TableBook | PassageBook], TableBook | PassageBook]
) -> None:
    passages = PassageBook((table_of(),))
    for each in (book, passages):
        assert each.choose("medium", 4, 2.5) is not None
        assert through(each) == each
