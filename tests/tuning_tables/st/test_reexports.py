"""Classes added, removed, reordered: RETARDER_SELECT gives the others what it gave them before."""

from __future__ import annotations

import numpy as np
import pytest

from tests.controller_code.test_reexports import AFTER, BEFORE, FIXED, book, commands
from tests.st_files import st_files
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.test_line_rules import select
from tuning_tables.export_prefix import RETARDER
from tuning_tables.self_test_size import SMALL
from tuning_tables.st_source import TABLE_FILE


def program_of(categories: tuple[str, ...]) -> Program:
    """The text of a book of these categories."""
    return Program(st_files(book(*categories), RETARDER, SMALL)[TABLE_FILE])


@pytest.mark.parametrize("after", AFTER, ids="-".join)
def test_the_same_commands_choose_the_same_tables(after: tuple[str, ...]) -> None:
    asked = commands()
    status, table = select(program_of(BEFORE), asked)
    status_now, table_now = select(program_of(after), asked)
    stayed = np.isin(asked["category"], [FIXED[each] for each in {*BEFORE} & {*after}])
    assert {0, 1, 2} <= set(status[stayed].tolist())
    assert np.array_equal(status[stayed], status_now[stayed])
    chosen = stayed & (status >= 0)
    for name in table.keys() - {"FAMILYNO"}:  # a number of the book, as its tables stand in it
        rows, rows_now = (
            np.broadcast_to(each[name], status.shape + np.shape(each[name])[1:]) for each in (table, table_now)
        )
        assert np.array_equal(rows[chosen], rows_now[chosen])
    assert (status_now[~np.isin(asked["category"], [FIXED[each] for each in after])] == -1).all()


def test_the_names_have_the_same_numbers_in_every_export() -> None:
    for categories in (BEFORE, *AFTER):
        program = program_of(categories)
        names = program.new("RETARDER_CATEGORIES")
        yard = {f"CATEGORY_{name}": number for number, name in enumerate(("L", "LS", "S", "ST", "T"), start=1)}
        own = {"CATEGORY_OWN": 16} if "own" in categories else {}
        assert {name: cell.value.item() for name, cell in names.items()} == yard | own
        program.call("RETARDER_CATEGORIES", names)
        assert {name: cell.value.item() for name, cell in names.items()} == yard | own
