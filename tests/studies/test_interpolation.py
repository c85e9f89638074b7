"""The study of lines between two tables: which speeds it asks for, and what it calls the worst."""

from __future__ import annotations

import pytest

from scripts.studies.interpolation import METHOD, Interpolated, Row, parted, worst_of


def row(target: float, tuned: float, book: float, low: float, between: bool = True) -> Row:
    return Row("a", target, between, tuned, book, 0.0, 0.0, book**2 - tuned**2, (low, 1.0))


def test_speeds_are_equal_parts_of_whole_steps() -> None:
    assert parted((4.0, 2.0), 1.0, 2) == [2.0, 2.5, 3.0, 3.5, 4.0]
    assert parted((2.0, 3.0), 5.0, 2) == [2.0, 2.5, 3.0]


def test_the_worst_is_where_the_rms_rises_most() -> None:
    rows = (row(2.5, 0.050, 0.052, 0.1), row(3.5, 0.020, 0.021, -0.1))
    assert worst_of(rows) == ("a", "0.0020 (4.0 %)", "0.0500", "2.5 m/s", "1 of 2 speeds")
    assert worst_of((row(2.5, 0.05, 0.049, -0.1),))[1] == "none"


def test_speeds_of_tables_are_in_no_table_of_speeds_between() -> None:
    found = Interpolated("0", 1, 2, (row(2.0, 1.0, 1.0, 0.0, between=False), row(2.5, 1.0, 1.1, 0.0)))
    assert [cells[1] for cells in found.tables()["between"].rows] == ["2.5"]


@pytest.mark.long
def test_a_book_gives_its_own_table_at_its_own_targets() -> None:
    found = METHOD.run(METHOD.smallest, print)
    own = [each for each in found.rows if not each.between]
    assert [each.target_m_s for each in own] == [2.0, 3.0, 4.0]
    assert all(each.tuned_rms_m_s == each.book_rms_m_s and each.excess_ci95_m2_s2 == (0.0, 0.0) for each in own)
    assert all(each.tuned_rms_m_s != each.book_rms_m_s for each in found.rows if each.between)
