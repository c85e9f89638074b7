"""Sheets for people: what a spreadsheet would compute is shown as text, and every number stays one."""

from __future__ import annotations

import csv
import io

import pytest

from tuning_tables.sheet import is_formula, sheet


@pytest.mark.parametrize("text", ["=1", "+1-2", "-a", "@SUM(A1)", "\t=1", "\r=1", "=", "-", "--1"])
def test_a_formula_gets_an_apostrophe(text: str) -> None:
    assert is_formula(text)
    assert cells([text])[0] == f"'{text}"


@pytest.mark.parametrize("text", ["", "a=1", "'=1", "cut-1", "-0.0123", "+15", "1e-3", "-inf", "СТ", 'a,"b"\nc'])
def test_all_else_stays_as_it_is(text: str) -> None:
    assert not is_formula(text)
    assert cells([text])[0] == text


def test_numbers_stay_numbers_and_names_of_columns_are_looked_at_too() -> None:
    assert cells([-1, -0.5, 2]) == ["-1", "-0.5", "2"]
    assert sheet(("=a", "b"), []) == b"'=a,b\r\n"


def cells(row: list[object]) -> list[str]:
    """`row`, written and read."""
    return list(csv.reader(io.StringIO(sheet(("a",), [row]).decode(), newline="")))[1]
