"""Classes added, removed, reordered: RETARDER_SELECT gives the others what it gave them before."""

from __future__ import annotations

import numpy as np
import pytest

from tests.controller_code.test_reexports import AFTER, BEFORE, FIXED, book, commands
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.test_select import select
from tuning_tables.st_source import TABLE_FILE, st_files


@pytest.mark.parametrize("after", AFTER, ids="-".join)
def test_the_same_commands_choose_the_same_tables(after: tuple[str, ...]) -> None:
    asked = commands()
    status, table = select(book(*BEFORE), asked)
    status_now, table_now = select(book(*after), asked)
    stayed = np.isin(asked["category"], [FIXED[each] for each in {*BEFORE} & {*after}])
    assert {0, 1, 2} <= set(status[stayed].tolist())
    assert np.array_equal(status[stayed], status_now[stayed])
    chosen = stayed & (status >= 0)
    for name in table:
        assert np.array_equal(table[name][chosen], table_now[name][chosen])
    assert (status_now[~np.isin(asked["category"], [FIXED[each] for each in after])] == -1).all()


def test_the_names_have_the_same_numbers_in_every_export() -> None:
    for categories in (BEFORE, *AFTER):
        program = Program(st_files(book(*categories))[TABLE_FILE])
        names = program.new("RETARDER_CATEGORIES")
        yard = {f"CATEGORY_{name}": number for number, name in enumerate(("L", "LS", "S", "ST", "T"), start=1)}
        own = {"CATEGORY_OWN": 16} if "own" in categories else {}
        assert {name: cell.value.item() for name, cell in names.items()} == yard | own
        program.call("RETARDER_CATEGORIES", names)
        assert {name: cell.value.item() for name, cell in names.items()} == yard | own
