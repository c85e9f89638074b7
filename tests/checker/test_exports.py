"""One changed digit, one table more or less, in any export of a tune is found."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
from dataclasses import replace
from pathlib import Path

import h5py
import pytest

from synth.checker.finding import DamagedError, Kind
from synth.checker.golden_export import vector_differences
from synth.checker.table_reading import Table, read_table
from tests.checker.planted_fault import Document, alone, found, judged, look, rewrite
from tests.controller_code.sample_book import FOUR_AXLES, surface_book, table_of
from tests.controller_code.unlike_pairs import at_rest
from tests.st_files import st_files
from tuning_tables import ControllerTable, Decisions, to_json
from tuning_tables.c_source import c_files
from tuning_tables.export_prefix import ExportPrefix
from tuning_tables.plc_forms.iec import unit_files
from tuning_tables.st_source import line_export
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


@pytest.mark.parametrize(
    ("name", "pattern", "replacement", "words"),
    [
        ("c/retarder_table.c", r"\S+, /\* mass_t", "0x1.8p+1f, /* mass_t", "the crc32 of table 0"),
        ("c/retarder_table.c", r"retarder_table_count = 2", "retarder_table_count = 1", "retarder_table_count is 1"),
        ("c/golden_vectors.csv", r"(?m)^(0(?:,[^,]*){4}),0,", r"\1,1,", r"golden_vectors.csv: row \d+ says 1"),
        ("st/retarder_table.st", r"(-?\d\.\d{8})\d(E-\d\d)", r"\g<1>X\2", "something else than REAL"),
        ("st/retarder_table.st", r"MassOf : ARRAY(.*?)\[(\s*)2", r"MassOf : ARRAY\1[\g<2>3", r"masst of table 0 is"),
    ],
)
def test_one_changed_digit_in_controller_code_is_found(
    tuned: Path, name: str, pattern: str, replacement: str, words: str
) -> None:
    change_text(tuned / name, pattern, replacement)
    kind = Kind.DAMAGED if "else than" in words or "count is" in words else Kind.DISAGREES
    assert found(look(tuned), kind, words)


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
