"""The canonical form is that of RFC 8785, the checksum that of zlib; CSV holds the whole table, and no formula."""

from __future__ import annotations

import csv
import io
import json
import re
import struct
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from synth.kernels.aim_speeds import aim_exit_speeds
from tests.tuning_tables.aim.made_tables import category_table, measured_table
from tests.tuning_tables.every_kind import smallest_aim
from tests.tuning_tables.passages.made_tables import table_of
from tuning_tables import ControllerTable, InvalidTable, to_csv, to_json, write_csv
from tuning_tables.aim import AimTable
from tuning_tables.csv_file import is_formula, sheet
from tuning_tables.json_text import canonical_json, crc32_hex, document_checksum


@pytest.mark.requirement("FILE-07")
def test_checksum_has_its_published_check_value() -> None:
    assert crc32_hex(b"123456789") == "cbf43926"
    assert crc32_hex(b"") == "00000000"


def test_checksum_of_the_worked_example_leaves_out_its_own_key() -> None:
    document = {"b": 1.0, "a": [0.5, None]}
    assert canonical_json(document) == b'{"a":[0.5,null],"b":1}'
    assert document_checksum(document) == document_checksum({**document, "crc32": "?"}) == "3f95c3d3"
    assert document_checksum({**document, "a": [0.5, 0]}) != "3f95c3d3"


@pytest.mark.requirement("FILE-07")
@pytest.mark.parametrize(
    ("bits", "text"),
    [  # RFC 8785, appendix B
        ("0000000000000000", "0"),
        ("8000000000000000", "0"),
        ("0000000000000001", "5e-324"),
        ("8000000000000001", "-5e-324"),
        ("7fefffffffffffff", "1.7976931348623157e+308"),
        ("ffefffffffffffff", "-1.7976931348623157e+308"),
        ("4340000000000000", "9007199254740992"),
        ("c340000000000000", "-9007199254740992"),
        ("4430000000000000", "295147905179352830000"),
        ("44b52d02c7e14af5", "9.999999999999997e+22"),
        ("44b52d02c7e14af6", "1e+23"),
        ("44b52d02c7e14af7", "1.0000000000000001e+23"),
        ("444b1ae4d6e2ef4e", "999999999999999700000"),
        ("444b1ae4d6e2ef4f", "999999999999999900000"),
        ("444b1ae4d6e2ef50", "1e+21"),
        ("3eb0c6f7a0b5ed8c", "9.999999999999997e-7"),
        ("3eb0c6f7a0b5ed8d", "0.000001"),
        ("41b3de4355555553", "333333333.3333332"),
        ("41b3de4355555557", "333333333.33333343"),
        ("becbf647612f3696", "-0.0000033333333333333333"),
        ("43143ff3c1cb0959", "1424953923781206.2"),
    ],
)
def test_numbers_are_written_as_the_standard_shows(bits: str, text: str) -> None:
    (number,) = struct.unpack(">d", bytes.fromhex(bits))
    assert canonical_json(number) == text.encode()


@pytest.mark.requirement("FILE-07")
def test_strings_and_key_order_are_written_as_the_standard_shows() -> None:
    # RFC 8785, sections 3.2.2 and 3.2.3
    assert canonical_json('\u20ac$\x0f\nA\'B"\\\\"/') == '"\u20ac$\\u000f\\nA\'B\\"\\\\\\\\\\"/"'.encode()
    keys = ["\u20ac", "\r", "\ufb33", "1", "\U0001f600", "\x80", "\u00f6"]
    written = json.loads(canonical_json(dict.fromkeys(keys, True)))
    assert list(written) == ["\r", "1", "\x80", "\u00f6", "\u20ac", "\U0001f600", "\ufb33"]


@given(st.floats(allow_nan=False, allow_infinity=False))
@settings(derandomize=True)
def test_every_number_reads_back_exactly(number: float) -> None:
    assert float(canonical_json(number)) == number


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        (float("nan"), "finite"),
        (float("-inf"), "finite"),
        (2**53 + 1, "beyond 2"),
        ({1: 2}, "string keys"),
        ({"a": object()}, "object has no JSON form"),
        (b"bytes", "bytes has no JSON form"),
        ([{"a": {1.5}}], "set has no JSON form"),
        ("\ud800", "surrogates not allowed"),
    ],
    ids=lambda given: re.sub(r" at 0x\w+", "", repr(given)),
)
def test_what_json_cannot_hold_is_refused(value: object, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        canonical_json(value)


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
