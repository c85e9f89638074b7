"""A reading of 0 m/s releases the brake and counts as seen; whoever loads the code is told so where he looks."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.controller_code.sample_book import sample_book
from tests.st_files import st_files
from tuning_tables.c_source import c_files
from tuning_tables.estimator import begin, unseen_samples
from tuning_tables.rule import decide_for, speed_for
from tuning_tables.st_source import TABLE_FILE

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "controllers.md"


@pytest.mark.requirement("RULE-10")
def test_zero_is_believed_and_lowers() -> None:
    table, state = sample_book().tables[0], begin()
    assert speed_for(table, state, 5.0, 0.0, 0.0) == 0.0
    assert unseen_samples(state) == 0
    assert decide_for(table, 2, 5.0, 0.0) == 0
    assert speed_for(table, state, 5.0, -1.0, 0.0) == -1.0
    assert unseen_samples(state) == 1
    assert decide_for(table, 2, 5.0, -1.0) == 2


def test_header_text_and_page_say_so() -> None:
    said = "is believed: the cut stands, so the brake is released"
    book = sample_book()
    for text in (c_files(book)["retarder_table.h"], st_files(book)[TABLE_FILE]):
        assert said in " ".join(text.decode().replace(" * ", " ").split())
    assert "**Without an estimator a reading of 0.0 m/s is believed" in PAGE.read_text(encoding="utf-8")
