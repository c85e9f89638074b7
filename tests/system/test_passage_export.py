"""export of tables for point sensors and of units of FMI: what is written, and what is refused in one sentence."""

from __future__ import annotations

import json
import shutil
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import typer.main

from synth.cli.commands import app
from synth.retarder.configuration.config_file import load_config
from synth.retarder.forms.table_forms import FORMS
from synth.retarder.served_class import plant_for
from tests.controller_code.fmi.unit_loop import loop_of_units, require_equal
from tests.controller_code.passage_tables import passage_book, passage_table
from tests.controller_code.sample_book import sample_book
from tests.effort import every, sized
from tests.frame.small_command import results_in
from tests.st_files import passage_st_files
from tests.system.conftest import Command
from tests.system.test_start_up import HEAVY, modules_after
from tuning_tables import RetarderId, read_book, write_book
from tuning_tables.csv_file import to_csv
from tuning_tables.export_names import RETARDER, ExportPrefix
from tuning_tables.json_file import to_json, write_json
from tuning_tables.language.st_layout import unit_files
from tuning_tables.passages.exports import passage_c_files, passage_export
from tuning_tables.passages.passage_book import PassageBook
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
    assert f"{output / 'retarder_passages.c'}: tables for point sensors in C99, exported by retarder-synth " in ran.out
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


NAMES = ["retarder_configuration.toml", "retarder_controller.fmu", "retarder_position.fmu"]
PASSES = sized(40, 1000)


def names_in(folder: Path) -> list[str]:
    """The files that a command has left, but for its mark."""
    return sorted(file.name for file in folder.iterdir() if not file.name.startswith("."))


def test_the_help_names_every_form() -> None:
    export = typer.main.get_command(app).commands["export"]  # type: ignore[attr-defined]  # click knows groups alone
    (option,) = (each for each in export.params if each.name == "form")
    assert option.metavar == "|".join(FORMS)


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")
def test_the_units_of_a_book_are_its_simulator(command: Command, tuned_once: tuple[Path, int], tmp_path: Path) -> None:
    source, folders = tuned_once[0], [tmp_path / name for name in ("one", "other")]
    for folder in folders:
        assert command("export", source, "--format", "fmu", "-o", folder).code == 0
    one, other = ([(folder / name).read_bytes() for name in NAMES] for folder in folders)
    assert one == other
    assert names_in(folders[0]) == NAMES
    config = load_config(source / "configuration.toml")
    tables = read_book(source / "book.h5")
    served = max(tables, key=lambda table: table.cut.mass_t)  # of two masses of a category the heavier one is chosen
    plant = plant_for(served, config, "here")[1]
    found = loop_of_units((one[1], one[2]), plant, served, 5, PASSES, tmp_path / "units")
    assert found.simulated.switchings.sum() > PASSES
    require_equal(found)


def test_the_units_of_both_versions_have_the_same_names(
    command: Command, tuned_once: tuple[Path, int], tmp_path: Path
) -> None:
    assert command("export", tuned_once[0], "--format", "fmu2", "-o", tmp_path).code == 0
    assert names_in(tmp_path) == NAMES
    for name in NAMES[1:]:
        with zipfile.ZipFile(tmp_path / name) as archive:
            assert b'fmiVersion="2.0"' in archive.read("modelDescription.xml")
            assert "sources/fmi2.c" in archive.namelist()


def test_what_is_missing_is_said(
    command: Command, tuned_once: tuple[Path, int], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    alone = tmp_path / "alone.h5"
    shutil.copy(tuned_once[0] / "book.h5", alone)
    ran = command("export", alone, "--format", "fmu", "--prefix", "PARK", "-o", tmp_path / "park")
    assert ran.code == 0
    assert "the position is not exported" in ran.sentence
    assert "is not the configuration that the tables were made of; give the directory of a tune" in ran.sentence
    assert names_in(tmp_path / "park") == ["park_controller.fmu"]
    monkeypatch.setattr(shutil, "which", lambda _name: None)
    ran = command("export", tuned_once[0], "--format", "fmu", "-o", tmp_path / "sources")
    assert (ran.code, "the units hold sources alone" in ran.sentence) == (0, True)
    for name in NAMES[1:]:
        with zipfile.ZipFile(tmp_path / "sources" / name) as archive:
            assert not [each for each in archive.namelist() if each.startswith("binaries")]


def test_other_tables_and_options_are_refused(command: Command, tuned_once: tuple[Path, int], tmp_path: Path) -> None:
    ran = command("export", tuned_once[0], "--format", "fmu", "--self-test", "small", "-o", tmp_path / "x")
    assert (ran.code, "--self-test is for --format c" in ran.sentence) == (2, True)
