"""The command export on a real, small book: every form is faithful, and what has no use is refused."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from tests.frame.small_command import results_in
from tests.system.conftest import EPOCH, Command
from tests.system.small_book import C_FILES, HEAVIER, ID
from tuning_tables import from_json, read_book, write_book


def test_a_directory_is_exported_and_validated_in_the_order_of_its_book(
    command: Command, two_classes: Path, tuned: Path, tmp_path: Path
) -> None:
    for source, name in ((tuned, "all"), (tuned / "book.h5", "book"), (tuned / "tables", "tables")):
        assert command("export", source, "--format", "c", "-o", tmp_path / name).code == 0
    whole, book, tables = (tmp_path / name / "retarder_table.c" for name in ("all", "book", "tables"))
    assert whole.read_bytes() == book.read_bytes()
    assert all(name in tables.read_text() for name in (ID, HEAVIER))
    ran = command("validate", tuned, "--config", two_classes, "--passes", "1000", "--json", "-o", tmp_path / "one")
    assert [row["id"] for row in json.loads(ran.out)["tables"]["tables"]] == [ID, HEAVIER]


def test_export_is_faithful(command: Command, tuned: Path, tmp_path: Path) -> None:
    assert command("export", tuned / "book.h5", "--format", "json", "-o", tmp_path / "new").code == 0
    for table in read_book(tuned / "book.h5"):
        exported = tmp_path / "new" / f"{table.id}.json"
        assert from_json(exported.read_bytes()) == table
        assert exported.read_bytes() == (tuned / "tables" / f"{table.id}.json").read_bytes()
    ran = command("export", tuned / "tables" / f"{ID}.json", "--format", "csv", "-o", tmp_path, "--json")
    assert json.loads(ran.out) == {"files": [str(tmp_path / f"{ID}.csv")]}
    ran = command("export", tuned / "book.h5", "--format", "xml")
    assert ran.code == 2
    assert "json, csv, c, st, plcopen, twincat, scl, fmu, fmu2" in ran.sentence


def test_export_of_controller_code_is_what_tune_leaves(command: Command, tuned: Path, tmp_path: Path) -> None:
    ran = command("export", tuned / "book.h5", "--format", "c", "-o", tmp_path / "c", "--json")
    assert ran.code == 0
    assert {Path(name).name for name in json.loads(ran.out)["files"]} == {*C_FILES, "retarder_configuration.toml"}
    for name in C_FILES:
        assert (tmp_path / "c" / name).read_bytes() == (tuned / "c" / name).read_bytes()
    ran = command("export", tuned / "tables" / f"{ID}.json", "--format", "st", "-o", tmp_path / "st")
    assert ran.code == 0
    names = {"retarder_table.st", "retarder_self_test.st", "retarder_configuration.toml"}
    assert set(results_in(tmp_path / "st")) == names


@pytest.mark.requirement("CORR-06")
def test_export_gives_the_correction_beside_unchanged_tables(command: Command, tuned: Path, tmp_path: Path) -> None:
    for form, options, new in (
        ("c", (), {"retarder_correction.c", "retarder_correction.h", "retarder_correction_self_test.c",
                   "retarder_correction_self_test.h", "golden_exits.csv"}),
        ("st", (), {"retarder_correction.st", "retarder_correction_self_test.st"}),
        ("st", ("--split",), {f"correction_{each}.st" for each in (
            "0001_RETARDER_CORRECTION_SETTING", "0002_RETARDER_CORRECTION", "0003_RETARDER_LOAD_CORRECTION",
            "0004_RETARDER_BEGIN_CORRECTION", "0005_RETARDER_USABLE_EXIT", "0006_RETARDER_LEARN_EXIT",
            "0007_RETARDER_CORRECTED_SPEED", "0008_RETARDER_CORRECTION_TEST_0", "0009_RETARDER_CORRECTION_EXITS_0",
            "0010_RETARDER_CORRECTION_PASSES_0", "0011_RETARDER_CORRECTION_SPEEDS_0",
            "0012_RETARDER_CORRECTION_SELF_TEST")}),
    ):  # fmt: skip
        folders = [tmp_path / f"{form}{len(options)}{name}" for name in ("plain", "corrected")]
        asked = ("export", tuned / "book.h5", "--format", form, *options)
        assert command(*asked, "-o", folders[0]).code == 0
        assert command(*asked, "--correction", "0.1", "-o", folders[1]).code == 0
        plain, corrected = (results_in(folder) for folder in folders)
        assert corrected.keys() - plain.keys() == new
        assert {name: corrected[name] for name in plain} == plain
    header = (tmp_path / "c0corrected" / "retarder_correction.h").read_text("ascii")
    assert "limit      0.1 m/s" in header


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (("--format", "csv", "--correction", "0.1"), "is for --format c, st, plcopen, twincat, scl, not for csv"),
        (("--format", "c", "--correction", "0.6"), "must lie between 0.01 and 0.5 m/s"),
        (("--format", "st", "--correction", "nan"), "must lie between 0.01 and 0.5 m/s"),
    ],
)
def test_a_correction_that_cannot_be_is_refused(
    command: Command, tuned: Path, options: tuple[str, ...], sentence: str
) -> None:
    ran = command("export", tuned / "book.h5", *options)
    assert ran.code == 2
    assert sentence in ran.sentence


@pytest.mark.parametrize(
    ("form", "options", "sentence"),
    [
        ("c", ("--prefix", "1st"), "--prefix 1st: the prefix is '1st', but it must have at most 10 Latin letters"),
        ("c", ("--self-test", "tiny"), "--self-test tiny: there is no such self-test; give full, small"),
        ("c", ("--split",), "--split is for --format st, not for c; leave it out"),
        ("scl", ("--split",), "--split is for --format st, not for scl; leave it out"),
        ("twincat", ("--prefix", "TRACK__2"), "--prefix TRACK__2: the prefix is 'TRACK__2', but it must have at most"),
        ("plcopen", ("--self-test", "tiny"), "--self-test tiny: there is no such self-test; give full, small"),
        ("json", ("--prefix", "A"), "--prefix is for --format c, st, plcopen, twincat, scl, fmu, fmu2, not for json;"),
        ("csv", ("--self-test", "small"), "--self-test is for --format c, st, plcopen, twincat, scl, not for csv;"),
    ],
)
def test_export_refuses_options_that_have_no_use(
    command: Command, tuned: Path, tmp_path: Path, form: str, options: tuple[str, ...], sentence: str
) -> None:
    ran = command("export", tuned / "book.h5", "--format", form, *options, "-o", tmp_path / "none")
    assert ran.code == 2
    assert sentence in ran.err
    assert not (tmp_path / "none").exists()


def test_export_for_the_tools_of_plc_engineers(command: Command, tuned: Path, tmp_path: Path) -> None:
    for form, names in {
        "plcopen": {"park_table.xml", "park_correction.xml"},
        "scl": {"park_table.scl", "park_self_test.scl", "park_correction.scl", "park_correction_self_test.scl"},
        "twincat": {"PARK_TABLE.TcDUT", "PARK_CORRECT.TcPOU", "self_test/PARK_SELF_TEST.TcPOU"},
    }.items():
        options = ("--format", form, "--prefix", "PARK", "--self-test", "small", "--correction", "0.15")
        for _ in range(2):  # it replaces what it wrote itself
            ran = command("export", tuned / "book.h5", *options, "-o", tmp_path / form)
            assert ran.code == 0
        files = {file.relative_to(tmp_path / form).as_posix() for file in (tmp_path / form).rglob("*.*")}
        told = {Path(line).relative_to(tmp_path / form).as_posix() for line in ran.out.splitlines()}
        assert files - {".retarder-synth"} == told
        assert names | {"park_configuration.toml"} <= told
        assert form == "twincat" or told == names | {"park_configuration.toml"}


def test_export_of_code_brings_the_configuration_that_tune_makes_the_same_tables_of(
    command: Command, tuned: Path, two_classes: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", EPOCH)
    assert command("export", tuned / "tables" / f"{ID}.json", "--format", "c", "-o", tmp_path / "c").code == 0
    copy = tmp_path / "c" / "retarder_configuration.toml"
    assert copy.read_bytes() == two_classes.read_bytes()
    assert command("tune", copy, "-o", tmp_path / "again", "--workers", "1").code == 0
    tables = sorted((tuned / "tables").iterdir())
    assert len(tables) == 4
    for file in (*tables, tuned / "book.h5", tuned / "c" / "retarder_table.c"):
        assert (tmp_path / "again" / file.relative_to(tuned)).read_bytes() == file.read_bytes()


def test_no_other_configuration_comes_with_an_export(command: Command, tuned: Path, tmp_path: Path) -> None:
    """Only that of these tables, and only as it was kept; it may lie in the folder above."""
    alone = tmp_path / "alone" / "alone"
    alone.mkdir(parents=True)
    shutil.copy(tuned / "tables" / f"{ID}.json", alone / "table.json")
    kept, summary = (tuned / "configuration.toml").read_text("utf-8"), (tuned / "summary.json").read_text("utf-8")
    sha256 = json.loads(summary)["generator"]["config_sha256"]

    def is_exported(folder: Path, summary: str, config: str) -> bool:
        (folder / "summary.json").write_text(summary, "utf-8")
        (folder / "configuration.toml").write_text(config, "utf-8")
        assert command("export", alone / "table.json", "--format", "st", "-o", tmp_path / "st").code == 0
        (folder / "summary.json").unlink()
        return (tmp_path / "st" / "retarder_configuration.toml").exists()

    for text in (summary.replace(sha256, "0" * 64), "[]", "{", '{"format": "another"}'):
        assert not is_exported(alone, text, kept)
    assert not is_exported(alone, summary, f"{kept}# mine")
    assert is_exported(alone.parent, summary, kept)


def test_export_says_which_tables_a_controller_never_chooses(command: Command, tuned: Path, tmp_path: Path) -> None:
    first, _ = read_book(tuned / "book.h5")
    lighter = replace(first, id="lighter", cut=replace(first.cut, mass_t=first.cut.mass_t - 1.0))
    write_book([first, lighter], tmp_path / "both.h5")
    ran = command("export", tmp_path / "both.h5", "--format", "c", "-o", tmp_path / "c")
    assert ran.code == 0
    assert ran.sentence.startswith(f"warning: {tmp_path}/both.h5: lighter is never chosen")
    other = replace(first, id="other", retarder=replace(first.retarder, name="another"))
    write_book([first, other], tmp_path / "mixed.h5")
    ran = command("export", tmp_path / "mixed.h5", "--format", "c", "-o", tmp_path / "none")
    assert ran.code == 2
    assert "a book serves one position" in ran.sentence
    assert not (tmp_path / "none").exists()
