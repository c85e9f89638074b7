"""A program that was written for another layout gets no table from RETARDER_SELECT, and the other way round."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.storage import Fault
from tuning_tables import read_json
from tuning_tables.st_source import TABLE_FILE, st_files
from tuning_tables.table_book import TableBook

OLD = Path(__file__).parents[2] / "controller_code" / "layout_1"

CALLER = """
FUNCTION_BLOCK CALLER
VAR
    Select : RETARDER_SELECT;
END_VAR
VAR_IN_OUT
    Table : RETARDER_TABLE;
END_VAR
VAR_OUTPUT
    Status : INT;
END_VAR
Select(Category := 1, Axles := 4, Commanded_m_s := 3.0, Table := Table);
Status := Select.Status;
END_FUNCTION_BLOCK
"""


def asked(text: bytes, caller: str) -> tuple[int, int, float]:
    """Status, stages and target of the table that a calling block gets, whose table was filled before."""
    program = Program(text + caller.encode("ascii"))
    table, block = program.new("RETARDER_TABLE"), program.new("CALLER")
    program.call("RETARDER_LOAD", program.new("RETARDER_LOAD"), TableNo=0, Table=table)
    assert table["STAGES"].value == 3
    program.call("CALLER", block, Table=table)
    return block["STATUS"].value.item(), table["STAGES"].value.item(), table["TARGET_M_S"].value.item()


def test_a_caller_of_another_layout_gets_no_table() -> None:
    same_book = TableBook(tuple(read_json(OLD / f"{name}.json") for name in ("loaded-to-3", "empty-to-3")))
    old_text, text = (OLD / TABLE_FILE).read_bytes(), st_files(same_book)[TABLE_FILE]
    assert asked(old_text, CALLER)[:2] == (0, 3)
    # An input that is not given is 0 in an instance that was never called with another: no layout.
    assert asked(text, CALLER)[:2] == (-3, 0)
    for layout, status in ((2, 0), (1, -3), (3, -3), (32767, -3)):
        caller = CALLER.replace("Category :=", f"Layout := {layout}, Category :=")
        assert asked(text, caller)[:2] == (status, 3 if status == 0 else 0)
        with pytest.raises(Fault, match="RETARDER_SELECT wants"):
            asked(old_text, caller)
