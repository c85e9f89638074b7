"""One changed digit, one table more or less, in any export is found; sound exports of many shapes agree."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import h5py
import pytest

from synth.checker.code_export import LINES, c_differences, st_differences
from synth.checker.finding import DamagedError, Kind
from synth.checker.line_exports import due_of_lines, vector_differences
from synth.checker.table_reading import Table, read_table
from tests.checker.planted_fault import Document, alone, found, judged, look, rewrite
from tests.controller_code.sample_book import (
    FOUR_AXLES,
    approaching_book,
    estimating_book,
    sample_book,
    surface_book,
    table_of,
)
from tests.controller_code.test_families import at_rest
from tests.st_files import st_files
from tuning_tables import ControllerTable, Decisions, to_json
from tuning_tables.export_names import ExportPrefix
from tuning_tables.exports import TABLE_FILE, c_files, line_export
from tuning_tables.language.st_layout import unit_files
from tuning_tables.self_test_size import SMALL
from tuning_tables.table_book import TableBook


def timed(table: ControllerTable) -> ControllerTable:
    """The table without slopes that decides at any time."""
    return replace(at_rest(table), decisions=Decisions.AT_ANY_TIME)


def swap_coefficients(document: Document) -> None:
    line = document["stages"][0]["upper"]
    line[0], line[1] = line[1], line[0]


@pytest.mark.requirement("VERIFY-05")
def test_swapped_coefficients_are_found_in_every_export(tuned: Path) -> None:
    rewrite(min((tuned / "tables").glob("*.json")), swap_coefficients)
    verdict = judged(tuned)
    for words in (
        r"but .* in book.h5",
        r"retarder_table.c: coefficient",
        r"retarder_table.st: coefficient",
        r"\.csv: the row",
    ):
        assert found(verdict, Kind.DISAGREES, words)


def test_a_wrong_checksum_is_damage(tuned: Path) -> None:
    table = alone(tuned)
    table.write_text(table.read_text(encoding="utf-8").replace('"target_speed_m_s": 1.5', '"target_speed_m_s": 1.25'))
    assert found(look(table), Kind.DAMAGED, "crc32")


def change_text(file: Path, pattern: str, replacement: str) -> None:
    text, count = re.subn(pattern, replacement, file.read_bytes().decode("utf-8"), count=1)
    assert count == 1
    file.write_bytes(text.encode("utf-8"))


def test_ids_that_look_like_names_of_the_code_are_compared_as_they_are(tmp_path: Path) -> None:
    made = [table_of(name, "BUNCH_X", 66.0, FOUR_AXLES, 2.0) for name in ("b", "BUNCH_SELECT", "retarder_load a")]
    tables = [replace(table, cut=replace(table.cut, category_number=16)) for table in made]
    book = TableBook(tuple(tables))
    exports = [form(book, ExportPrefix("BUNCH")) for form in (c_files, st_files)]
    exports += [c_files(book), unit_files(line_export(book, ExportPrefix("bunch_2")))]
    for name, content in (file for files in exports for file in files.items()):
        (tmp_path / name).write_bytes(content)
    for table in tables:
        (tmp_path / f"{table.id}.json").write_bytes(to_json(table))
    verdict = judged(tmp_path)
    assert verdict.findings == ()
    assert {"bunch_table.c", "bunch_table.st", "0004_BUNCH_2_LOAD.st", "retarder_table.c"} <= set(verdict.files)


def surfaces(tables: int = 12) -> tuple[bytes, list[Table]]:
    """The golden vectors of a book that decides at any time, and its tables as the checker reads them."""
    book = TableBook(surface_book().tables[:tables])
    return c_files(book)["golden_vectors.csv"], [read_table(to_json(table)) for table in book.tables]


def disagreements(golden: bytes, tables: list[Table]) -> list[str]:
    """All sentences about golden vectors."""
    return [sentence for _, sentence in vector_differences(golden, tables)]


def test_golden_vectors_of_surfaces_are_found_right() -> None:
    assert disagreements(*surfaces()) == []


def test_golden_vectors_at_another_pressure_are_found() -> None:
    golden, tables = surfaces(1)
    rows = golden.decode("utf-8").splitlines()
    changed = 0
    for place, row in enumerate(rows[1:], start=1):
        fields = row.split(",")
        if fields[5] not in ("43160000", "7fc00000"):  # 150 kPa, NaN
            rows[place] = ",".join([*fields[:5], "43160000", *fields[6:]])
            changed += 1
    assert changed > 100
    sentences = disagreements("\r\n".join([*rows, ""]).encode("utf-8"), tables)
    assert [sentence for sentence in sentences if "but the rule says" in sentence]


def test_columns_of_a_gauge_are_expected_only_where_there_is_one() -> None:
    golden, tables = surfaces(1)
    rested, plain = (TableBook(tuple(each(table) for table in surface_book().tables[:1])) for each in (at_rest, timed))
    for book in (rested, plain):
        own = [read_table(to_json(table)) for table in book.tables]
        with pytest.raises(DamagedError, match="its first line is not"):
            disagreements(golden, own)
        with pytest.raises(DamagedError, match="its first line is not"):
            disagreements(c_files(book)["golden_vectors.csv"], tables)


def test_one_changed_digit_in_csv_is_found(tuned: Path) -> None:
    file = min((tuned / "tables").glob("*.csv"))
    change_text(file, r"(number,stages.0.upper,[-0-9.e]*)([0-8])([,\r])", r"\g<1>9\3")
    assert found(look(tuned), Kind.DISAGREES, "the row number,stages.0.upper holds")


def test_a_flipped_bit_in_the_book_is_found(tuned: Path) -> None:
    content = bytearray((tuned / "book.h5").read_bytes())
    content[len(content) // 2] ^= 1
    (tuned / "book.h5").write_bytes(content)
    assert found(look(tuned), Kind.DAMAGED, "book.h5: its seal")


def seal_anew(book: Path) -> None:
    """Give a changed book the seal that fits it."""
    body = book.read_bytes().partition(b"\n# sealed")[0]
    seal = f"\n# sealed, sha256 of all before this line: {hashlib.sha256(body).hexdigest()}\n"
    book.write_bytes(body + seal.encode())


def test_a_changed_number_under_a_right_seal_is_found(tuned: Path) -> None:
    book = tuned / "book.h5"
    with h5py.File(book, "r+") as file:
        file["stage_upper"][0, 0, 0] += 0.5
    seal_anew(book)
    assert found(look(book), Kind.DAMAGED, "payload_sha256")


def test_a_book_that_points_elsewhere_is_not_followed(tuned: Path) -> None:
    book = tuned / "book.h5"
    other = Path(shutil.copy(book, tuned / "other.h5"))
    with h5py.File(book, "r+") as file:
        del file["cut_mass_t"]
        file["cut_mass_t"] = h5py.ExternalLink(str(other), "cut_mass_t")
    seal_anew(book)
    assert found(look(book), Kind.DAMAGED, "mass_t is no dataset of its own")


@pytest.mark.requirement("VERIFY-05")
def test_a_removed_table_is_missed(tuned: Path) -> None:
    min((tuned / "tables").glob("*.json")).unlink()
    verdict = judged(tuned)
    assert found(verdict, Kind.DISAGREES, "in book.h5, but has no sound JSON file")
    assert found(verdict, Kind.DISAGREES, "lists it, but it is not there")


def test_a_removed_csv_is_missed(tuned: Path) -> None:
    min((tuned / "tables").glob("*.csv")).unlink()
    assert found(look(tuned), Kind.DISAGREES, "it has none")


@pytest.mark.requirement("VERIFY-05")
def test_a_table_too_many_is_found(tuned: Path) -> None:
    table = min((tuned / "tables").glob("*.json"))
    copy = Path(shutil.copy(table, table.with_name("copy.json")))
    rewrite(copy, lambda document: document.update(id="another"))
    verdict = judged(tuned)
    assert found(verdict, Kind.DISAGREES, "another: it has a JSON file, but it is not in book.h5")
    assert found(verdict, Kind.DISAGREES, "it holds 2 tables, but there are 3")


def test_a_changed_configuration_is_not_believed(tuned: Path) -> None:
    change_text(tuned / "summary.json", r'"common_cv":\s*0\.15', '"common_cv":0.05')
    assert found(look(tuned), Kind.DISAGREES, "its configuration hashes to")


def test_other_figures_in_the_summary_are_found(tuned: Path) -> None:
    summary = json.loads((tuned / "summary.json").read_text(encoding="utf-8"))
    summary["tables"]["cases"][0]["predicted_rms_m_s"] *= 0.5
    (tuned / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    assert found(look(tuned), Kind.DISAGREES, "but summary.json says")


NUMBER = r"-?(?:0x[01][0-9a-f.]*p[+-]\d+f|\d[\d.]*(?:E[+-]\d+)?)"


@cache
def exported(tables: int = 3) -> tuple[dict[str, str], tuple[Table, ...]]:
    """The texts of a book with approaches, slopes and estimators, and its tables as the checker reads them."""
    book = TableBook(surface_book(approaching_book()).tables[:tables])
    content = {**c_files(book, self_test=SMALL), TABLE_FILE: st_files(book, self_test=SMALL)[TABLE_FILE]}
    texts = {name: text.decode("utf-8") for name, text in content.items()}
    return texts, tuple(read_table(to_json(table)) for table in book.tables)


def sentences(texts: dict[str, str], tables: tuple[Table, ...]) -> list[str]:
    """All that is found in both languages."""
    found = [
        *c_differences(texts["retarder_table.c"], texts["retarder_table.h"], "RETARDER", LINES, due_of_lines(tables)),
        *st_differences(texts[TABLE_FILE], "RETARDER", LINES, due_of_lines(tables)),
    ]
    return [sentence for _, sentence in found]


def changed(text: str, pattern: str) -> str:
    """The text with the number in the group of the pattern another one."""
    found = re.search(pattern, text)
    assert found is not None, pattern
    old = found[1]
    new = "0x1.8p+7f" if "p" in old else "7.5" if "." in old else "7"
    return text[: found.start(1)] + new + text[found.end(1) :]


@pytest.mark.parametrize("made", [sample_book, estimating_book, approaching_book, surface_book])
def test_exports_of_many_shapes_agree_with_their_tables(made: Callable[[], TableBook]) -> None:
    book = made()
    tables = tuple(read_table(to_json(table)) for table in book.tables)
    files = {**c_files(book, self_test=SMALL), **st_files(book, self_test=SMALL)}
    assert sentences({name: text.decode("utf-8") for name, text in files.items()}, tables) == []


@pytest.mark.parametrize("name", ["MassOf", "TargetOf", "CategoryOf"])
def test_a_column_that_differs_in_another_block_is_found(name: str) -> None:
    texts, tables = exported()
    head, block, tail = texts[TABLE_FILE].partition("FUNCTION_BLOCK RETARDER_CHOOSE")
    text = head + block + changed(tail, rf"\b{name} : ARRAY\S+ OF \w+ := \[\s*({NUMBER})")
    assert any(name in sentence for sentence in sentences({**texts, TABLE_FILE: text}, tables))


@pytest.mark.parametrize(
    ("name", "pattern", "replacement", "words"),
    [
        ("retarder_table.c", r"retarder_table_count = 3", "retarder_table_count = 2", "retarder_table_count is 2"),
        ("retarder_table.c", r"\S+, /\* mass_t", "0x1.zp, /* mass_t", "is no number of a table"),
        ("retarder_table.c", r"\d+, /\* axles", "091, /* axles", "091 is no whole number"),
        ("retarder_table.c", r"(0x1\.\w+p\+\d+f), (0x)", r"\1, 0x1p+0f, \2", "words, but its struct has"),
        ("retarder_table.h", r"    int32_t axles;.*\n", "", "words, but its struct has"),
        ("retarder_table.h", r"    uint32_t crc32;.*\n", "", "does not end with its checksum"),
        ("retarder_table.h", r"\} retarder_table;", "} other;", "has no struct retarder_table"),
        ("retarder_table.h", r"(CATEGORY_\w+) 1 ", r"\1 2 ", "defines the categories"),
        (TABLE_FILE, r"(-?\d\.\d{8})\d(E-\d\d)", r"\g<1>X\2", "something else than REAL"),
        (TABLE_FILE, r"ApproachOf : .*\n", "\n", "approachm of table 0 is missing"),
        (TABLE_FILE, r"Brake_0 : ", "Brake_9 : ", "brake of table 0 is missing"),
        (TABLE_FILE, r"ARRAY\[0\.\.2\] OF INT := \[", "ARRAY[0..3] OF INT := [", "but is declared with 4"),
        (TABLE_FILE, r"RETARDER_TABLE : STRUCT", "OTHER : STRUCT", "has no type RETARDER_TABLE"),
        (TABLE_FILE, r"FUNCTION_BLOCK RETARDER_LOAD", "FUNCTION_BLOCK OTHER", "has no block RETARDER_LOAD"),
    ],
)
def test_a_damaged_export_is_found(name: str, pattern: str, replacement: str, words: str) -> None:
    texts, tables = exported()
    text, count = re.subn(pattern, replacement, texts[name], count=1)
    assert count == 1
    try:
        found = sentences({**texts, name: text}, tables)
    except DamagedError as damage:
        found = [str(damage)]
    assert any(re.search(words, sentence) for sentence in found), found


def test_another_number_of_tables_is_found() -> None:
    texts, tables = exported()
    found = sentences(texts, tables[:2])
    assert found.count("it holds 3 tables, but there are 2") == 2
