"""export and inspect of tables for point sensors: the files that are written, and what is refused in one sentence."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from tests.controller_code.passage_tables import passage_book, passage_table
from tests.controller_code.sample_book import sample_book
from tests.effort import every
from tests.frame.results import results_in
from tests.st_files import passage_st_files
from tests.system.conftest import Command
from tests.system.test_start_up import HEAVY, modules_after
from tuning_tables import RetarderId, write_book
from tuning_tables.csv_file import to_csv
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.json_file import to_json, write_json
from tuning_tables.passages.c_source import passage_c_files
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.st_source import passage_export
from tuning_tables.plc_forms.iec import unit_files
from tuning_tables.self_test_size import SMALL

BOOK = PassageBook(passage_book().tables[:3])


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A directory with tables/, whose file names are in the order of the book."""
    (tmp_path / "points" / "tables").mkdir(parents=True)
    for number, table in enumerate(BOOK.tables):
        write_json(table, tmp_path / "points" / "tables" / f"{number}.json")
    return tmp_path / "points"


@pytest.mark.parametrize(
    ("options", "expected"),
    every(3, [
        (("--format", "c"), lambda: passage_c_files(BOOK)),
        (("--format", "c", "--prefix", "Dumper", "--self-test", "small"),
         lambda: passage_c_files(BOOK, ExportPrefix("Dumper"), SMALL)),
        (("--format", "st"), lambda: passage_st_files(BOOK)),
        (("--format", "st", "--split", "--self-test", "small"),
         lambda: unit_files(passage_export(BOOK, RETARDER, SMALL))),
        (("--format", "json"), lambda: {f"{table.id.replace(' ', '-')}.json": to_json(table)
                                        for table in BOOK.tables}),
        (("--format", "csv"), lambda: {f"{table.id.replace(' ', '-')}.csv": to_csv(table)
                                       for table in BOOK.tables}),
    ]),
)  # fmt: skip
def test_export_of_a_directory_and_of_a_book(
    command: Command, folder: Path, tmp_path: Path, options: tuple[str, ...], expected: Callable[[], dict[str, bytes]]
) -> None:
    write_book(BOOK.tables, tmp_path / "book.h5")
    for source in (folder, tmp_path / "book.h5"):
        ran = command("export", source, *options, "-o", tmp_path / f"from-{source.name}", "--json")
        assert ran.code == 0
        files = results_in(tmp_path / f"from-{source.name}")
        assert files == expected()
        assert {Path(name).name for name in json.loads(ran.out)["files"]} == set(files)
        assert ("shadow is never chosen" in ran.err) == (options[1] in ("c", "st"))


def test_export_of_one_table_needs_nothing_heavy(command: Command, folder: Path, tmp_path: Path) -> None:
    source, output = folder / "tables" / "0.json", tmp_path / "c"
    assert modules_after(["export", str(source), "--format", "c", "-o", str(output)]).isdisjoint({*HEAVY, "h5py"})
    alone = passage_c_files(PassageBook(BOOK.tables[:1]))
    assert (output / "retarder_passages.c").read_bytes() == alone["retarder_passages.c"]
    ran = command("inspect", output)
    assert f"{output / 'retarder_passages.c'}: tables for point sensors in C99; verify compares them" in ran.out
    assert command("export", source, "--format", "st", "-o", tmp_path / "st").code == 0
    assert "tables for point sensors in Structured Text" in command("inspect", tmp_path / "st").out


def test_what_makes_no_export_is_refused(command: Command, folder: Path, tmp_path: Path) -> None:
    ran = command("export", folder, "--format", "c", "--correction", "0.1")
    assert (ran.code, ran.out) == (2, "")
    assert "--correction is for tables with lines" in ran.sentence
    other = replace(passage_table("else"), retarder=RetarderId("РНЗ-2М", ((0.0, 6.0),), 37.45, 10.0))
    write_json(other, folder / "tables" / "3.json")
    ran = command("export", folder, "--format", "c", "-o", tmp_path / "c")
    assert ran.code == 2
    assert "a book serves one position: export them apart" in ran.sentence
    damaged = (folder / "tables" / "0.json").read_bytes().replace(b"2.5", b"2.6", 1)
    (tmp_path / "damaged.json").write_bytes(damaged)
    ran = command("export", tmp_path / "damaged.json", "--format", "c")
    assert ran.code == 3
    assert "damaged.json" in ran.sentence
    assert command("export", tmp_path / "missing.json", "--format", "c").code == 2


def test_tables_with_lines_are_exported_as_before(command: Command, tmp_path: Path) -> None:
    write_json(sample_book().tables[0], tmp_path / "lines.json")
    assert command("export", tmp_path / "lines.json", "--format", "c", "-o", tmp_path / "c").code == 0
    assert "retarder_table.c" in {path.name for path in (tmp_path / "c").iterdir()}
