"""The choice among tables for point sensors: that of table books, without lines between; what makes no book."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.controller_code.passage_tables import BUNCH, passage_book, passage_table
from tests.controller_code.sample_book import FOUR_AXLES, table_of
from tuning_tables import CutId, InvalidTable, RetarderId, Status, TableBook
from tuning_tables.passages.golden_selections import golden_selections
from tuning_tables.passages.passage_book import PassageBook, PassageChoice

BOOK = passage_book()
SPEEDS = st.floats(0.0, 6.0) | st.floats(width=32) | st.sampled_from([2.5, 3.5, float(np.nextafter(3.5, 9.0))])


def test_the_choice_is_the_heaviest_then_the_next_target_below() -> None:
    to_2_5, to_3_5 = 0, 2
    assert BOOK.choose("Л", 4, 2.5) == PassageChoice(Status.TUNED, to_2_5)
    assert BOOK.choose("Л", 4, 3.0) == PassageChoice(Status.SLOWER, to_2_5)
    assert BOOK.choose("Л", 4, 3.5) == PassageChoice(Status.TUNED, to_3_5)
    assert BOOK.choose("Л", 4, 9.0) == PassageChoice(Status.SLOWER, to_3_5)
    assert BOOK.choose("Л", 4, 2.4) == PassageChoice(Status.NO_TARGET, None)
    assert BOOK.choose("Л", 4, float("nan")) == PassageChoice(Status.NO_TARGET, None)
    assert BOOK.choose("Л", 6, 2.5) == PassageChoice(Status.NO_CLASS, None)
    assert [table.id for table in BOOK.shadowed()] == ["shadow"]


@given(SPEEDS)
def test_it_is_the_choice_of_a_book_of_tables_with_lines(speed_m_s: float) -> None:
    """Of other degrees, so that no lines between them are possible."""
    made = [
        replace(table_of(each.id, "Л", each.cut.mass_t, FOUR_AXLES, each.target_speed_m_s, 5, 1 + place), cut=each.cut)
        for place, each in enumerate(BOOK.tables[:3])
    ]
    due = TableBook(tuple(made)).choose("Л", 4, speed_m_s)
    found = PassageBook(BOOK.tables[:3]).choose("Л", 4, speed_m_s)
    assert (found.status, () if found.number is None else (found.number,)) == (due.status, due.numbers)


def test_golden_selections_reach_every_status() -> None:
    rows = golden_selections(BOOK)
    assert {row.status for row in rows} == {Status.TUNED, Status.SLOWER, Status.NO_CLASS, Status.NO_TARGET}
    assert {row.table for row in rows} == {0, 2, 3, 4, 5, len(BOOK.tables)}


def test_what_makes_no_book() -> None:
    first = passage_table()
    other = replace(first, id="other", target_speed_m_s=3.5)
    with pytest.raises(InvalidTable, match="at least one"):
        PassageBook(())
    with pytest.raises(InvalidTable, match="given to 2 tables"):
        PassageBook((first, first))
    with pytest.raises(InvalidTable, match="export them apart"):
        PassageBook((first, replace(other, retarder=RetarderId("else", ((0.0, 26.0),), 37.45, 15.0))))
    with pytest.raises(InvalidTable, match="other sensors than bunch"):
        PassageBook((first, passage_table("other", places_m=(*BUNCH[:-1], 40.0))))
    unnumbered = replace(other, cut=CutId("mine", 23.0, FOUR_AXLES))
    with pytest.raises(InvalidTable, match="has no number"):
        PassageBook((first, unnumbered)).exported_numbers()
    twice = replace(other, cut=CutId("mine", 23.0, FOUR_AXLES, 16))
    with pytest.raises(InvalidTable, match="has the number 16 in other, but None in third"):
        PassageBook((first, twice, replace(unnumbered, id="third")))
