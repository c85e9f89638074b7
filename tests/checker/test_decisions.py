"""The checker's rule answers hard readings as Python's does: ties, jumps, incredible readings, stages out of range."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from scripts.studies.in_the_loop.agreement import ask
from synth.checker.float32 import decide, rises
from synth.checker.table_reading import read_table
from tests.controller_code.sample_book import approaching_book, sample_book, surface_book
from tuning_tables import to_json
from tuning_tables.table_book import TableBook

READINGS = 60_000


@pytest.mark.requirement("VERIFY-06")
@pytest.mark.parametrize("made", [sample_book, approaching_book, surface_book])
def test_hard_readings_are_decided_alike(made: Callable[[], TableBook]) -> None:
    book = made()
    tables = [read_table(to_json(table)) for table in book.tables]
    asked = ask(book, READINGS, 10, 20261124)
    found = []
    for number, stage, s, v, kpa in asked.readings.tolist():
        table = tables[number]
        added = rises(table.slopes, table.pressures_kpa, table.top_stage, stage, kpa)
        limits = table.entrance_stage, table.farthest
        found.append(decide(table.lines, table.path_m, *limits, stage, s, v, added))
    assert found == asked.decisions.tolist()
    far = asked.decisions - asked.readings["stage"]
    assert np.count_nonzero(abs(far) > 1) > 500
    assert min(np.count_nonzero(far < 0), np.count_nonzero(far == 0), np.count_nonzero(far > 0)) > 1_000
