"""A category has one number, in every form of a table."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import jsonschema
import pytest

from plant_models.library import load_weight_categories
from synth.checker.book_reading import read_documents
from synth.checker.document_shape import YARD
from synth.checker.source import SHAPES
from synth.checker.table_reading import read_table
from tests.st_files import st_files
from tuning_tables import (
    ControllerTable,
    CutId,
    DamagedTable,
    InvalidTable,
    from_json,
    read_book,
    table_schema,
    to_csv,
    to_json,
    write_book,
)
from tuning_tables.category_number import KNOWN_NUMBERS
from tuning_tables.exports import c_files
from tuning_tables.json_text import canonical_json, document_checksum
from tuning_tables.table_book import TableBook

UNNUMBERED = Path(__file__).parent / "st" / "default_book"
AXLES = (0.0, 1.85, 8.65, 10.5)


def test_library_tables_and_checker_number_the_same() -> None:
    assert {c.name: c.number for c in load_weight_categories().members} == dict(KNOWN_NUMBERS) == YARD


def test_tables_of_the_yard_are_numbered_by_name(tmp_path: Path) -> None:
    tables = []
    for file in sorted(UNNUMBERED.glob("*.json")):
        content = file.read_bytes()
        tables.append(from_json(content))
        assert to_json(tables[-1]) == content
        assert tables[-1].cut.category_number is None
        assert b"category_number" not in to_csv(tables[-1])
        assert read_table(content).category_number == tables[-1].cut.number
    assert [table.cut.number for table in tables] == [1, 1, 1, 3, 3, 3]
    write_book(tables, tmp_path / "book.h5")
    with h5py.File(tmp_path / "book.h5") as book:
        assert not book["cut_category_number"][:].any()
    assert read_book(tmp_path / "book.h5") == tuple(tables)


def numbered(table: ControllerTable, category: str, number: int | None, **changes: Any) -> ControllerTable:
    return replace(table, cut=replace(table.cut, category=category, category_number=number), **changes)


@pytest.mark.requirement("CODE-12")
@pytest.mark.parametrize(("category", "number"), [("Л", 1), ("Т", 5), ("own", 16), ("T", 255)])
def test_a_number_survives_every_form(table: ControllerTable, tmp_path: Path, category: str, number: int) -> None:
    made = numbered(table, category, number)
    document = json.loads(to_json(made))
    assert from_json(to_json(made)) == from_json(canonical_json(document)) == made
    assert read_table(to_json(made)).category_number == number
    jsonschema.validate(document, table_schema("lines"))
    assert f"number,cut.category_number,{number},".encode() in to_csv(made)
    # Of a book only one table may state it.
    write_book([made, replace(table, id="unnumbered")], tmp_path / "book.h5")
    assert read_book(tmp_path / "book.h5") == (made, replace(table, id="unnumbered"))
    with h5py.File(tmp_path / "book.h5") as book:
        assert book["cut_category_number"][:].tolist() == [number, 0]
    found = [each["cut"]["category_number"] for each in read_documents((tmp_path / "book.h5").read_bytes(), SHAPES)]
    assert found == [number, None]


@pytest.mark.parametrize(
    ("category", "number", "reason"),
    [
        ("Л", 2, "Л is 2, but it must be 1, its number in every table"),
        ("Л", True, "Л is True, but it must be 1"),
        ("own", 5, r"own is 5, but it must be a whole number in \[16, 255\]"),
        ("own", 15, "own is 15"),
        ("own", 256, "own is 256"),
        ("own", 16.0, "own is 16.0"),
    ],
)
def test_a_number_that_is_another_one_s_is_refused(
    table: ControllerTable, category: str, number: float, reason: str
) -> None:
    with pytest.raises(InvalidTable, match=f"cut.category_number of the category {reason}"):
        CutId(category, 22.0, AXLES, number)  # type: ignore[arg-type]  # 16.0 is refused too
    if number == 16.0:  # in JSON it is the whole number
        return
    document = json.loads(to_json(table))
    document["cut"] |= {"category": category, "category_number": number}
    document["crc32"] = document_checksum(document)
    with pytest.raises(DamagedTable, match="category_number"):
        from_json(canonical_json(document))
    assert not jsonschema.Draft202012Validator(table_schema("lines")).is_valid(document)


def test_in_one_book_a_name_has_one_number_and_a_number_one_name(table: ControllerTable, tmp_path: Path) -> None:
    first = numbered(table, "own", 16)
    for second, reason in (
        (numbered(table, "own", 17, id="b"), "the category own has the number 16 in leer-22t-4.0, but 17 in b"),
        (numbered(table, "own", None, id="b"), "the category own has the number 16 in leer-22t-4.0, but None in b"),
        (numbered(table, "other", 16, id="b"), "the number 16 stands for the category own in leer-22t-4.0, but for"),
    ):
        with pytest.raises(InvalidTable, match=reason):
            TableBook((first, second))
        with pytest.raises(InvalidTable, match=reason):
            write_book([first, second], tmp_path / "book.h5")
    # An old table of the yard has the number that new ones state.
    book = TableBook((numbered(table, "Л", 1), numbered(table, "Л", None, id="old", target_speed_m_s=3.0)))
    assert book.category_numbers == {"Л": 1}


@pytest.mark.requirement("CODE-12")
@pytest.mark.parametrize("export", [c_files, st_files])
def test_controller_code_of_a_category_without_number_is_refused(
    table: ControllerTable, export: Callable[[TableBook], Mapping[str, bytes]]
) -> None:
    with pytest.raises(InvalidTable, match=r"leer-22t-4.0 is for the category medium, which has no number, .* give "):
        export(TableBook((table,)))
    assert export(TableBook((numbered(table, "medium", 16),)))
