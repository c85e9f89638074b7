"""The CSV file holds the whole table: read back by other means, it gives the JSON document again."""

import csv
import io
import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from synth.kernels.aim_speeds import aim_exit_speeds
from tests.tuning_tables.aim.made_tables import category_table, measured_table
from tests.tuning_tables.every_kind import smallest_aim
from tests.tuning_tables.passages.made_tables import table_of
from tuning_tables import ControllerTable, InvalidTable, to_csv, to_json, write_csv
from tuning_tables.aim import AimTable


@pytest.mark.requirement("FILE-05")
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
        leaves = dict(flattened(document))
        for row in rows:
            if row["record"] == "text":
                assert leaves.pop(row["key"]) == row["value0"]
            elif row["record"] == "number":
                assert leaves.pop(row["key"]) == numbers(row)
        # What is null has no row.
        assert set(leaves.values()) <= {None}
        assert ("validated" in leaves) == (exported.validated is None)
        assert len([key for key in leaves if key.endswith(("lower", "upper"))]) == int((~exported.has_line).sum())


def test_a_switching_speed_that_is_never_reached_is_infinite() -> None:
    table = table_of()
    rows = csv.reader(io.StringIO(to_csv(table).decode("utf-8"), newline=""))
    told = {(record, key): values for record, key, *values in rows}
    assert told["text", "kind"][0] == "passages"
    for index, passage in enumerate(table.passages):
        for stage, row in enumerate(passage.switching_m_s):
            key = f"passages.{index}.switching_m_s.{stage}"
            assert [float(value) for value in told["number", key][:2]] == list(row)


@pytest.mark.parametrize("make", [category_table, measured_table, smallest_aim])
def test_every_node_of_an_aim_table_has_a_row(make: Callable[[], AimTable]) -> None:
    table, document = make(), json.loads(to_json(make()))
    rows = list(csv.reader(io.StringIO(to_csv(table).decode(), newline="")))
    assert len({len(row) for row in rows}) == 1
    by_key = {tuple(row[:2]): row[2:] for row in rows}
    assert len(by_key) == len(rows)
    assert by_key["number", "required.p_overspeed"][0] == "0.1"
    assert by_key["number", "bounds_m_s"][:2] == ["0.5", "7.0"]
    assert by_key["number", "axes.cars"][: len(table.axes.cars)] == [str(cars) for cars in document["axes"]["cars"]]
    assert by_key["text", "crc32"][0] == document["crc32"]
    assert ("number", "exit_speed_m_s") not in by_key
    names = [name for name in by_key["names", "node"] if name]
    nodes = [dict(zip(names, row[2:], strict=False)) for row in rows if row[0] == "node"]
    assert len(nodes) == table.exit_speed_m_s.size
    speeds = [float(node["exit_speed_m_s"] or "nan") for node in nodes]
    assert np.array_equal(speeds, table.exit_speed_m_s.ravel(), equal_nan=True)
    asked = [[float(node[name] or "nan") for node in nodes] for name in ("free_distance_m", "resistance_n_per_kn")]
    answers = aim_exit_speeds(table.held, [int(node["cars"]) for node in nodes], *asked)
    assert np.array_equal(answers, np.array(speeds, np.float32), equal_nan=True)


def test_rows_form_a_rectangle_and_equal_tables_give_equal_bytes(table: ControllerTable, tmp_path: Path) -> None:
    write_csv(table, tmp_path / "table.csv")
    content = (tmp_path / "table.csv").read_bytes()
    assert content == to_csv(table)
    assert content.endswith(b"\r\n")
    widths = {len(row) for row in csv.reader(io.StringIO(content.decode("utf-8"), newline=""))}
    assert widths == {2 + 4}


def numbers(row: Mapping[str, str]) -> tuple[float, ...]:
    return tuple(float(value) for name, value in row.items() if name.startswith("value") and value)


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
