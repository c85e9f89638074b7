"""The choice that controller code is asked for: that of table books, without lines between two tables."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.controller_code.passage_tables import passage_book, passage_table
from tests.controller_code.sample_book import FOUR_AXLES, table_of
from tests.st_files import passage_st_files
from tuning_tables import CutId, InvalidTable, Status, TableBook
from tuning_tables.passages.c_source import passage_c_files
from tuning_tables.passages.golden_selections import golden_selections
from tuning_tables.passages.passage_book import PassageBook

BOOK = passage_book()
SPEEDS = st.floats(0.0, 6.0) | st.floats(width=32) | st.sampled_from([2.5, 3.5, float(np.nextafter(3.5, 9.0))])


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
    assert {row.table for row in rows} == {0, 2, 3, 4, 5, None}


def test_a_category_without_number_is_not_exported() -> None:
    unnumbered = replace(passage_table(), cut=CutId("mine", 23.0, FOUR_AXLES))
    for write in (passage_c_files, passage_st_files):
        with pytest.raises(InvalidTable, match="has no number, but controller code chooses by number"):
            write(PassageBook((unnumbered,)))
