"""Aim tables as files: read back as written, refused with any fault, and described by their schema."""

from __future__ import annotations

import copy
import csv
import io
import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

from synth.kernels.aim_speeds import aim_exit_speeds
from tests.tuning_tables.aim.made_tables import category_table, measured_table, random_table, reported_of
from tuning_tables.aim import (
    AimAxes,
    AimTable,
    aim_schema,
    from_aim_json,
    read_aim_json,
    to_aim_csv,
    to_aim_json,
    write_aim_csv,
    write_aim_json,
)
from tuning_tables.canonical import canonical_json, document_checksum
from tuning_tables.errors import DamagedTable, InvalidTable, NewerVersion, OlderVersion, TableError, UnknownFormat

Document = dict[str, Any]
JsonPath = tuple[str | int, ...]
TELLING_BYTES = b"\x00\t\n\r \"'+,-./0123456789:E[\\]_aeflnux{}\x7f\x80\xc3\xff"


def smallest_table() -> AimTable:
    """Two cars, two distances, one null, numbers of other forms."""
    speeds = np.array([[0.5, np.nan], [1.0000001, 7.0]])
    axes = AimAxes(np.array([1, 2]), np.array([0.0, 1e3 / 3.0]))
    return replace(category_table(), axes=axes, exit_speed_m_s=speeds, reported=reported_of(speeds))


def smallest_measured_table() -> AimTable:
    """One number of cars, two distances, two resistances, one null."""
    speeds = np.array([[[1.0, 1.5], [np.nan, 2.0]]])
    axes = AimAxes(np.array([1]), np.array([10.0, 20.0]), np.array([0.5, 1.5]))
    return replace(measured_table(), axes=axes, exit_speed_m_s=speeds, reported=reported_of(speeds))


def resealed(document: Document) -> bytes:
    return canonical_json({**document, "crc32": document_checksum(document)})


@pytest.mark.parametrize("seed", range(30))
@pytest.mark.parametrize("measured", [False, True])
def test_what_is_written_is_read(tmp_path: Path, seed: int, measured: bool) -> None:
    table = random_table(seed, measured)
    write_aim_json(table, tmp_path / "aim.json")
    read = read_aim_json(tmp_path / "aim.json")
    assert (tmp_path / "aim.json").read_bytes() == to_aim_json(table) == to_aim_json(read)
    for name in ("id", "created", "generator", "position", "category", "required", "knowledge", "bounds_m_s"):
        assert getattr(read, name) == getattr(table, name)
    assert np.array_equal(read.exit_speed_m_s, table.exit_speed_m_s, equal_nan=True)
    assert [np.asarray(one).tobytes() for one in read.held] == [np.asarray(one).tobytes() for one in table.held]
    assert to_aim_json(from_aim_json(canonical_json(json.loads(to_aim_json(table))))) == to_aim_json(table)


def changed_texts(content: bytes) -> Iterator[bytes]:
    for at in range(len(content)):
        before, this, after = content[:at], content[at : at + 1], content[at + 1 :]
        yield before + after
        yield before + this + this + after
        yield before + after[:1] + this + after[1:]
        for bit in range(8):
            yield before + bytes([this[0] ^ 1 << bit]) + after
        yield before + TELLING_BYTES[at % len(TELLING_BYTES)].to_bytes() + this + after


@pytest.mark.parametrize("canonical", [False, True])
def test_no_flipped_bit_and_no_lost_doubled_inserted_or_transposed_byte_gets_through(canonical: bool) -> None:
    content = to_aim_json(smallest_table())
    if canonical:
        content = canonical_json(json.loads(content))
    tried = 0
    for changed in changed_texts(content):
        if changed != content:
            tried += 1
            with pytest.raises(TableError):
                from_aim_json(changed)
    assert tried > 11.5 * len(content)


@pytest.mark.parametrize(
    ("change", "error", "words"),
    [
        (lambda d: d.update(format="retarder-table"), UnknownFormat, 'it must be "aim-table"; give an aim table'),
        (lambda d: d.pop("format"), UnknownFormat, "format is None"),
        (lambda d: d.update(version=2), NewerVersion, "this reader knows only 1; update"),
        (lambda d: d.update(version=0), OlderVersion, "export it again"),
        (lambda d: d.update(version=1.5), DamagedTable, "the whole number 1"),
        (lambda d: d.update(version=True), DamagedTable, "the whole number 1"),
        (lambda d: d.pop("bounds"), DamagedTable, "bounds is missing"),
        (lambda d: d.update(surplus=1), DamagedTable, "unknown key 'surplus'"),
        (lambda d: d["axes"].pop("cars"), DamagedTable, "axes.cars is missing"),
        (lambda d: d["reported"].update(more=1), DamagedTable, "reported has the unknown key 'more'"),
        (lambda d: d["knowledge"].update(kind="guess"), DamagedTable, "knowledge is .* whose kind is one of category"),
        (lambda d: d.update(knowledge=None), DamagedTable, "knowledge is None"),
        (lambda d: d["knowledge"].update(from_m=1.0), DamagedTable, "knowledge has the unknown key"),
        (lambda d: d["axes"].update(cars=[1.5, 2.5]), DamagedTable, r"axes.cars\[0\] is 1.5, but .* a whole number"),
        (lambda d: d["axes"].update(free_distance_m=[2.0, 1.0]), DamagedTable, "axes.free_distance_m is .* must rise"),
        (lambda d: d["axes"].update(cars=[1]), DamagedTable, r"exit_speed_m_s is .* an array of 1, as the axes say"),
        (lambda d: d["exit_speed_m_s"][0].append(1.0), DamagedTable, r"exit_speed_m_s\[0\] is .* an array of 2"),
        (lambda d: d["exit_speed_m_s"][0].pop(), DamagedTable, r"exit_speed_m_s\[0\] is .* an array of 2"),
        (lambda d: d["exit_speed_m_s"].__setitem__(1, None), DamagedTable, r"exit_speed_m_s\[1\] is None"),
        (lambda d: d["exit_speed_m_s"][1].__setitem__(0, "1"), DamagedTable, r"\[1\]\[0\] is '1', but .* or null"),
        (lambda d: d["exit_speed_m_s"][1].__setitem__(0, True), DamagedTable, r"\[1\]\[0\] is True, but .* or null"),
        (lambda d: d["exit_speed_m_s"][1].__setitem__(0, 8.0), DamagedTable, "or within"),
        (lambda d: d["exit_speed_m_s"][0].__setitem__(0, 2**70), DamagedTable, "crc32"),
        (lambda d: d["reported"]["p_overspeed"][1].__setitem__(1, 0.2), DamagedTable, "within its interval"),
        (lambda d: d["reported"]["mean_gap_m"][1].__setitem__(1, None), DamagedTable, "mean_gap_m.* null exactly"),
        (lambda d: d["reported"].update(passes=0), DamagedTable, "reported.passes"),
        (lambda d: d["required"].update(p_overspeed=1.0), DamagedTable, r"within \(0, 1\)"),
        (lambda d: d["required"].update(p_overspeed=0.0), DamagedTable, r"within \(0, 1\)"),
        (lambda d: d["category"].update(number=3), DamagedTable, "category.number of the category Л"),
        (lambda d: d["bounds"].update(exit_speed_m_s=[1.0]), DamagedTable, "an array of two numbers"),
        (lambda d: d.update(created="2026"), DamagedTable, "created is '2026'"),
    ],
)  # fmt: skip
def test_a_planted_fault_is_refused_under_a_right_checksum(
    change: Callable[[Document], Any], error: type[TableError], words: str
) -> None:
    document = json.loads(to_aim_json(smallest_table()))
    change(document)
    try:
        content = resealed(document)
    except ValueError:  # it has no canonical form, and so no checksum
        content = json.dumps(document).encode()
    with pytest.raises(error, match=words) as refusal:
        from_aim_json(content, "aim.json")
    assert str(refusal.value).startswith("aim.json: ")
    assert len(str(refusal.value)) < 600


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        (b'"error_m_s": 0.012', b'"error_m_s": NaN', "NaN is no JSON number"),
        (b'"error_m_s": 0.012', b'"error_m_s": 1e999', "finite"),
        (b'"error_m_s": 0.012', b'"error_m_s": -0.0', "without a sign"),
        (b'"error_m_s": 0.012', b'"error_m_s": 0.012, "error_m_s": 0.012', "given twice"),
        (b'"error_m_s": 0.012', b'"error_m_s": 0.0120', "laid out otherwise"),
        (b'"error_m_s": 0.012', b'"error_m_s": 0.013', "crc32 is"),
        (b"0.5, null", b"0.5, -0.0", "crc32 is"),
        (b'"version": 1', b'"version": ' + b"[" * 100_000, "nested too deep"),
        ("Л".encode(), b"\xff", "not a complete JSON text"),
    ],
)
def test_text_that_is_no_table_is_refused(before: bytes, after: bytes, words: str) -> None:
    content = to_aim_json(smallest_table())
    assert content.count(before) == 1
    changed = content.replace(before, after)
    if b"-0.0" in after or b"1e999" in after:
        document = json.loads(changed)
        if "crc32" not in words and b"-0.0" in after:
            changed = changed.replace(document["crc32"].encode(), document_checksum(document).encode())
        elif b"1e999" in after:
            words = "no checksum"
    with pytest.raises(DamagedTable, match=words):
        from_aim_json(changed)


def test_files_that_hold_no_table_are_refused(tmp_path: Path) -> None:
    with pytest.raises(DamagedTable, match="longer than 4194304 bytes"):
        from_aim_json(b" " * (4 * 2**20 + 1))
    with pytest.raises(IsADirectoryError):
        read_aim_json(tmp_path)
    with pytest.raises(FileNotFoundError):
        read_aim_json(tmp_path / "none.json")
    with pytest.raises(UnknownFormat):
        from_aim_json(b"[]")


@pytest.fixture(scope="module")
def validator() -> jsonschema.Draft202012Validator:
    jsonschema.Draft202012Validator.check_schema(aim_schema())
    return jsonschema.Draft202012Validator(aim_schema())


def test_tables_conform_to_the_schema(validator: jsonschema.Draft202012Validator) -> None:
    made = [category_table(0.6, 16, "own"), measured_table(), smallest_table()]
    for table in [*made, *(random_table(seed, seed % 2 == 1) for seed in range(20))]:
        assert list(validator.iter_errors(json.loads(to_aim_json(table)))) == []


def places(value: Any, path: JsonPath = ()) -> Iterator[JsonPath]:
    yield path
    members = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, member in members:
        yield from places(member, (*path, key))


def altered(document: Document, path: JsonPath, value: object) -> Document:
    document = copy.deepcopy(document)
    parent: Any = document
    for key in path[:-1]:
        parent = parent[key]
    parent[path[-1]] = value
    return document


@pytest.mark.parametrize("wrong", [None, True, "", [], {}, -1], ids=repr)
@pytest.mark.parametrize("make", [smallest_table, smallest_measured_table])
def test_what_the_schema_refuses_the_reader_refuses_too(
    validator: jsonschema.Draft202012Validator, make: Callable[[], AimTable], wrong: object
) -> None:
    document = json.loads(to_aim_json(make()))
    refused = 0
    for path in places(document):
        if not path or path[0] in ("format", "version", "crc32"):
            continue
        changed = altered(document, path, wrong)
        if not validator.is_valid(changed):
            refused += 1
            with pytest.raises(DamagedTable):
                from_aim_json(resealed(changed))
    assert refused >= 25


def test_a_speed_that_falls_with_the_resistance_is_refused() -> None:
    document = json.loads(to_aim_json(smallest_measured_table()))
    document["exit_speed_m_s"][0][0] = [1.5, 1.0]
    with pytest.raises(DamagedTable, match=r"exit_speed_m_s\[0\]\[0\]\[1\] is 1.0, but it must be no less than"):
        from_aim_json(resealed(document))


def test_kind_and_axis_belong_together_in_the_schema(validator: jsonschema.Draft202012Validator) -> None:
    by_category, measured = (json.loads(to_aim_json(make())) for make in (category_table, measured_table))
    for wrong in ({**by_category, "knowledge": measured["knowledge"]}, {**measured, "knowledge": {"kind": "category"}}):
        assert not validator.is_valid(wrong)
        with pytest.raises(DamagedTable, match=r"axes\.resistance_n_per_kn"):
            from_aim_json(resealed(wrong))


@pytest.mark.parametrize("make", [category_table, measured_table, smallest_table])
def test_csv_says_the_same(make: Callable[[], AimTable], tmp_path: Path) -> None:
    table, document = make(), json.loads(to_aim_json(make()))
    write_aim_csv(table, tmp_path / "aim.csv")
    assert (tmp_path / "aim.csv").read_bytes() == to_aim_csv(table)
    rows = list(csv.reader(io.StringIO(to_aim_csv(table).decode(), newline="")))
    assert len({len(row) for row in rows}) == 1
    by_key = {tuple(row[:2]): row[2:] for row in rows}
    assert len(by_key) == len(rows)
    assert by_key["number", "required.p_overspeed"][0] == "0.1"
    assert by_key["number", "bounds.exit_speed_m_s"][:2] == ["0.5", "7.0"]
    assert by_key["text", "crc32"][0] == document["crc32"]
    names = [name for name in by_key["names", "node"] if name]
    nodes = [dict(zip(names, row[2:], strict=False)) for row in rows if row[0] == "node"]
    assert len(nodes) == table.exit_speed_m_s.size
    speeds = [float(node["exit_speed_m_s"] or "nan") for node in nodes]
    assert np.array_equal(speeds, table.exit_speed_m_s.ravel(), equal_nan=True)
    asked = [[float(node[name] or "nan") for node in nodes] for name in ("free_distance_m", "resistance_n_per_kn")]
    answers = aim_exit_speeds(table.held, [int(node["cars"]) for node in nodes], *asked)
    assert np.array_equal(answers, np.array(speeds, np.float32), equal_nan=True)


def test_a_name_that_a_spreadsheet_would_compute_makes_no_csv() -> None:
    with pytest.raises(InvalidTable, match="a spreadsheet would compute"):
        to_aim_csv(replace(category_table(), id="=1+1"))
