"""`export --format fmu`: the units of a tuned book are its simulator; what is missing is said in a sentence."""

from __future__ import annotations

import shutil
import zipfile
from pathlib import Path

import pytest
import typer.main

from synth.cli.commands import app
from synth.retarder.configuration.config_file import load_config
from synth.retarder.forms.table_forms import FORMS
from synth.retarder.served_class import plant_for
from tests.controller_code.fmi.unit_loop import loop_of_units, require_equal
from tests.effort import sized
from tests.system.conftest import Command
from tuning_tables import read_book

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
