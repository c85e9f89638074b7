"""The CSV file holds the whole table: read back by other means, it gives the JSON document again."""

import csv
import io
import json
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tuning_tables import ControllerTable, InvalidTable, to_csv, to_json, write_csv


def test_every_value_reads_back_exactly(
    table: ControllerTable,
    linear_table: ControllerTable,
    approached_estimate: ControllerTable,
    surface_table: ControllerTable,
    surface_estimate: ControllerTable,
) -> None:
    for exported in (table, linear_table, approached_estimate, surface_table, surface_estimate):
        rows = list(csv.DictReader(io.StringIO(to_csv(exported).decode("utf-8"), newline="")))
        document = json.loads(to_json(exported))
        lines = {(row["record"], int(row["key"])): numbers(row) for row in rows if row["record"] in ("lower", "upper")}
        for stage in exported.stages:
            assert lines.pop(("lower", stage.k), None) == stage.lower
            assert lines.pop(("upper", stage.k), None) == stage.upper
        assert not lines
        leaves = dict(flattened({**document, "stages": [without_lines(stage) for stage in document["stages"]]}))
        for row in rows:
            if row["record"] == "text":
                assert leaves.pop(row["key"]) == row["value0"]
            elif row["record"] == "number":
                assert leaves.pop(row["key"]) == numbers(row)
        # What is null has no row: the figures of no closed loop, and the slope of no line.
        missing = {key for key in leaves if key == "validated" or key.endswith("_slope_m_s_per_kpa")}
        assert leaves == dict.fromkeys(missing)
        assert ("validated" in missing) == (exported.validated is None)
        assert len(missing - {"validated"}) == exported.has_gauge * int((~exported.has_line).sum())


def test_rows_form_a_rectangle_and_equal_tables_give_equal_bytes(table: ControllerTable, tmp_path: Path) -> None:
    write_csv(table, tmp_path / "table.csv")
    content = (tmp_path / "table.csv").read_bytes()
    assert content == to_csv(table)
    assert content.endswith(b"\r\n")
    widths = {len(row) for row in csv.reader(io.StringIO(content.decode("utf-8"), newline=""))}
    assert widths == {2 + 4}


def numbers(row: Mapping[str, str]) -> tuple[float, ...]:
    return tuple(float(value) for name, value in row.items() if name.startswith("value") and value)


def without_lines(stage: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in stage.items() if key not in ("lower", "upper")}


def flattened(value: Any, key: str = "") -> Iterator[tuple[str, Any]]:
    """(dotted key, string or tuple of numbers) of each leaf; an array of numbers is one leaf."""
    if isinstance(value, dict):
        for name, member in value.items():
            yield from flattened(member, f"{key}.{name}" if key else name)
    elif isinstance(value, list) and not isinstance(value[0], int | float):
        for index, item in enumerate(value):
            yield from flattened(item, f"{key}.{index}")
    elif isinstance(value, list):
        yield key, tuple(value)
    else:
        yield key, (value,) if isinstance(value, int | float) else value


@pytest.mark.parametrize("mark", ["=", "+", "-", "@"])
def test_no_cell_is_a_formula(table: ControllerTable, tmp_path: Path, mark: str) -> None:
    for forged in (
        replace(table, id=f"{mark}cmd|' /C calc'!A0"),
        replace(table, cut=replace(table.cut, category=f"{mark}1")),
        replace(table, retarder=replace(table.retarder, name=f"{mark}1")),
    ):
        with pytest.raises(InvalidTable, match="a spreadsheet would compute"):
            write_csv(forged, tmp_path / "table.csv")
    assert list(tmp_path.iterdir()) == []
