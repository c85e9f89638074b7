"""The study of lines between two tables: which speeds it asks for, and what it calls the worst."""

from __future__ import annotations

import pytest

from scripts.studies.interpolation import METHOD


@pytest.mark.long
def test_a_book_gives_its_own_table_at_its_own_targets() -> None:
    found = METHOD.run(METHOD.smallest, print)
    own = [each for each in found.rows if not each.between]
    assert [each.target_m_s for each in own] == [2.0, 3.0, 4.0]
    assert all(each.tuned_rms_m_s == each.book_rms_m_s and each.excess_ci95_m2_s2 == (0.0, 0.0) for each in own)
    assert all(each.tuned_rms_m_s != each.book_rms_m_s for each in found.rows if each.between)
