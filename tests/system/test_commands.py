"""Every command on a real, small book: exit codes, what is printed, what is written."""

from __future__ import annotations

import hashlib
import json
import shutil
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from synth.frame.results_directory import results_directory
from synth.retarder.configuration.config_file import parse_config
from tests.frame.results import results_in
from tests.system.conftest import CLASS, EPOCH, Command, changed
from tuning_tables import from_json, read_book, read_json, to_csv, to_json, write_book
from tuning_tables.canonical import canonical_json, document_checksum
from tuning_tables.pass_log.log_files import read_logs

ID = "gondola-4-22t-to-1.5-m-s"
HEAVIER = "gondola-4-30t-to-1.5-m-s"
C_FILES = {
    "retarder_table.h", "retarder_table.c", "retarder_self_test.h", "retarder_self_test.c", "golden_vectors.csv",
    "golden_tracks.csv",
}  # fmt: skip


def summary_of(directory: Path) -> dict[str, Any]:
    summary: dict[str, Any] = json.loads((directory / "summary.json").read_bytes())
    return summary


def test_tune_leaves_what_the_contract_says(tuned_once: tuple[Path, int]) -> None:
    directory, code = tuned_once
    assert code == 0
    files = set(results_in(directory))
    assert {"book.h5", "report.html", "summary.json", f"tables/{ID}.json", f"tables/{ID}.csv"} <= files
    assert {"plots/rms-by-controller.svg", "plots/feasibility.svg"} <= files
    assert {path.name for path in (directory / "c").iterdir()} == C_FILES
    summary = summary_of(directory)
    assert set(summary["files"]) == files - {"summary.json"}
    for name, digest in summary["files"].items():
        assert hashlib.sha256((directory / name).read_bytes()).hexdigest() == digest
    assert {t.cut.category: t.cut.category_number for t in read_book(directory / "book.h5")} == {"Л": 1, "ЛС": 2}
    assert read_json(directory / "tables" / f"{ID}.json").cut.category_number == 1


def test_the_summary_tells_the_figures_of_the_tables(tuned_once: tuple[Path, int], two_classes: Path) -> None:
    directory, _ = tuned_once
    summary = summary_of(directory)
    assert (summary["format"], summary["command"], summary["accepted"]) == ("retarder-synth-summary", "tune", True)
    assert summary["created"] == "2023-11-14T22:13:20Z"
    assert summary["generator"]["config_sha256"] == parse_config(two_classes.read_text(), "two.toml").sha256
    tables = read_book(directory / "book.h5")
    rows = summary["tables"]
    assert [case["id"] for case in rows["cases"]] == [table.id for table in tables] == [ID, HEAVIER]
    known = [row for row in rows["controllers"] if row["controller"] == "friction known"]
    for case, table, bound in zip(rows["cases"], tables, known, strict=True):
        assert read_json(directory / "tables" / f"{case['id']}.json") == table
        assert to_csv(table) == (directory / "tables" / f"{table.id}.csv").read_bytes()
        assert table.validated is not None
        low, high = table.validated.rms_ci95_m_s
        n = table.validated.passes
        assert case["rms_m_s"] == {"value": table.validated.rms_m_s, "low95": low, "high95": high, "n": n}
        assert case["predicted_rms_m_s"] == pytest.approx(table.predicted.rms_m_s)
        assert case["prediction_ratio"]["value"] == pytest.approx(table.predicted.rms_m_s / table.validated.rms_m_s)
        assert case["regret"]["value"] == pytest.approx(table.validated.rms_m_s / bound["rms_m_s"]["value"])
        assert case["best_baseline"] in {row["controller"] for row in rows["controllers"]}
        assert case["verdict"] == "accepted"


def test_tune_prints_a_table_and_where_things_are(command: Command, one_class: Path, tmp_path: Path) -> None:
    plain = one_class.with_name("plain.toml")
    plain.write_text(CLASS.replace("csv = true", "plots = false\nreport = false"))
    ran = command("tune", plain, "-o", tmp_path / "out")
    assert ran.code == 0
    assert "gondola-4-22t" in ran.out
    assert "accepted: the limits are kept in 1 feasible case" in ran.out
    assert f"{tmp_path / 'out'}: c/, sheets/, tables/, book.h5, configuration.toml, summary.json" in ran.out
    assert "report" not in ran.out
    assert "[1/1] gondola-4-22t to 1.5 m/s: rms 0.0" in ran.err
    files = {name for name in summary_of(tmp_path / "out")["files"] if not name.startswith("sheets/")}
    assert files == {"book.h5", "configuration.toml", *(f"c/{name}" for name in C_FILES), f"tables/{ID}.json"}


def test_missed_limits_give_1_and_stale_files_go(command: Command, one_class: Path, tuned: Path) -> None:
    strict = one_class.with_name("strict.toml")
    strict.write_text(
        changed(
            CLASS, ("csv = true", "plots = false\nreport = false"), ("prediction_ratio_high = 1.35", "rms_m_s = 0.01")
        )
    )
    (tuned / "tables" / "my-notes.json").write_text("{}")
    (tuned / "plots" / "my-photo.png").write_bytes(b"photo")
    leftover = tuned / "tables" / f".{HEAVIER}.json.{'0' * 16}.part"
    leftover.write_text("half")
    ran = command("tune", strict, "-o", tuned, "--json")
    assert ran.code == 1
    summary = json.loads(ran.out)
    assert summary == summary_of(tuned)
    assert (summary["accepted"], summary["tables"]["cases"][0]["verdict"]) == (False, "missed")
    (limit,) = summary["limits"]
    assert limit["kept"] is False
    assert "gondola-4-22t, target 1.5 m/s: rms 0.0" in limit["sentence"]
    assert sorted(path.name for path in tuned.glob("tables/*")) == [f"{ID}.json", "my-notes.json"]
    assert [path.name for path in tuned.glob("plots/*")] == ["my-photo.png"]
    assert not (tuned / "report.html").exists()
    assert not leftover.exists()


def test_an_infeasible_book_is_not_accepted(command: Command, one_class: Path, tmp_path: Path) -> None:
    hopeless = one_class.with_name("hopeless.toml")
    hopeless.write_text(CLASS.replace("high_m_s = 4.0", "high_m_s = 5.5").replace("csv = true", "plots = false"))
    ran = command("tune", hopeless, "-o", tmp_path)
    assert ran.code == 1
    assert "gondola-4-22t, target 1.5 m/s, brake saturated: entry speeds from 1.51 to" in ran.out
    assert "no case is feasible" in ran.out
    again = command("validate", tmp_path / "book.h5", "--config", hopeless, "-o", tmp_path / "again")
    assert again.code == 0  # known to be infeasible, from the summary beside it
    assert "summary.json beside the tables calls this case infeasible" in again.out
    (tmp_path / "summary.json").unlink()
    assert command("validate", tmp_path / "book.h5", "--config", hopeless, "-o", tmp_path / "again").code == 1


def test_a_second_tune_into_the_same_directory_is_refused(command: Command, one_class: Path, tuned: Path) -> None:
    with results_directory(tuned, "tune"):
        ran = command("tune", one_class, "-o", tuned)
    assert ran.code == 2
    assert "another tune is writing there" in ran.sentence


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


def test_validate_confirms_what_the_tables_say(
    command: Command, tuned: Path, two_classes: Path, tmp_path: Path
) -> None:
    ran = command("validate", tuned / "book.h5", "--config", two_classes, "--json", "-o", tmp_path / "one")
    assert ran.code == 0
    found = json.loads(ran.out)
    assert (found["warnings"], found["accepted"]) == ([], True)
    for each, table in zip(found["tables"]["tables"], read_book(tuned / "book.h5"), strict=True):
        assert table.validated is not None
        assert each["rms_m_s"]["value"] == table.validated.rms_m_s  # the same passes
        assert each["stated_rms_m_s"] == each["rms_m_s"]
        assert (each["confirmed"], each["same_config"]) == (True, True)
    given = ("validate", tuned / "tables" / f"{ID}.json", "--config", two_classes, "-o", tmp_path / "other")
    other = command(*given, "--seed", 7, "--passes", 4000)
    assert other.code == 0
    assert "limits kept, as stated" in other.out
    assert "4000 stratified passes of each table, seed 7" in other.out


@pytest.mark.parametrize(("name", "std"), [("log.csv", "0"), ("log.h5", "none")])
def test_validate_logs_passes_as_a_controller_would(
    command: Command, tuned: Path, two_classes: Path, tmp_path: Path, name: str, std: str
) -> None:
    given = ("validate", tuned / "book.h5", "--config", two_classes, "--passes", 1000, "--log", name, "-o", tmp_path)
    ran = command(*given, "--log-passes", 30, "--gauge-std", std)
    assert ran.code == 0
    assert f"30 passes of each table, as a controller logs them: {name}" in ran.out
    tables = read_book(tuned / "book.h5")
    loaded = read_logs([tmp_path / name], None, len(tables[0].stages) - 1)
    assert loaded.faults == ()
    log = loaded.log
    assert Counter(log.mass_t.tolist()) == {22.0: 30, 30.0: 30}
    assert set(log.target_m_s) == {1.5}
    assert log.has_gauge == (std == "0")
    if log.has_gauge:  # a drive at rest is within the dead band of its stage, and an exact gauge shows it there
        apart_kpa = np.abs(log.pressure_kpa - np.array([stage.pressure_kpa for stage in tables[0].stages])[log.stage])
        assert np.median(apart_kpa) <= tables[0].retarder.dead_band_kpa


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--log", "log.xlsx"), "--log is 'log.xlsx'; it must be the name of a file in DIR that ends in .csv or .h5"),
        (("--log", "a/log.csv"), "--log is 'a/log.csv'; it must be the name of a file in DIR"),
        (("--log-passes", 5), "are about a log; name its file in DIR by --log NAME.csv"),
        (("--gauge-std", "none"), "are about a log; name its file in DIR by --log NAME.csv"),
        *(
            (("--log", "log.csv", "--gauge-std", word), f"--gauge-std is '{word}'; it must be 0 to 100 kPa, or none")
            for word in ("-1", "nan", "101", "much")
        ),
    ],
)
def test_validate_refuses_a_log_that_cannot_be(
    command: Command, tuned: Path, tmp_path: Path, words: tuple[object, ...], says: str
) -> None:
    ran = command("validate", tuned / "book.h5", *words, "-o", tmp_path / "out")
    assert (ran.code, ran.out) == (2, "")
    assert says in ran.sentence
    assert not (tmp_path / "out").exists()


def test_validate_finds_a_table_that_lies(command: Command, tuned: Path, two_classes: Path, tmp_path: Path) -> None:
    path = tuned / "tables" / f"{ID}.json"
    table = read_json(path)
    text = to_json(table).decode().replace(f'"rms_m_s": {table.predicted.rms_m_s!r}', '"rms_m_s": 0.005')
    document = json.loads(text)
    document.pop("crc32")
    document["crc32"] = document_checksum(document)
    path.write_bytes(canonical_json(document))
    ran = command("validate", path, "--config", two_classes, "-o", tmp_path / "out")
    assert ran.code == 1
    assert "predicted / simulated rms 0.2" in ran.out


def test_validate_refuses_a_plant_that_does_not_fit(command: Command, tuned: Path, tmp_path: Path) -> None:
    ran = command("validate", tuned / "book.h5", "-o", tmp_path / "out")
    assert ran.code == 2
    assert "no cut class fits the table gondola-4-22t-to-1.5-m-s" in ran.sentence
    assert "retarder.zones_m" in ran.sentence


def test_inspect_tells_the_contents(command: Command, tuned: Path) -> None:
    ran = command("inspect", tuned)
    assert ran.code == 0
    assert f"{ID}: leave with 1.5 m/s" in ran.out
    assert "stage 1 (150 kPa) down below" in ran.out
    assert "its CRC-32 is right" in ran.out
    assert "that it lists are there unchanged" in ran.out
    found = json.loads(command("inspect", tuned / "book.h5", "--json").out)
    assert [table["id"] for table in found["files"][0]["tables"]] == [ID, HEAVIER]
    assert found["files"][0]["tables"][0]["lines_at"][0]["k"] == 0


def test_inspect_finds_a_file_that_does_not_belong(command: Command, tuned: Path) -> None:
    (tuned / "report.html").write_text("another")
    ran = command("inspect", tuned)
    assert ran.code == 3
    assert "report.html: its SHA-256 is not the one in summary.json" in ran.sentence


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
    assert "json, csv, c, st, plcopen, twincat, scl, fmu" in ran.sentence


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


@pytest.mark.long
def test_export_takes_a_prefix_a_small_self_test_and_splits(
    command: Command, tuned: Path, measured_once: Path, tmp_path: Path
) -> None:
    book = tuned / "book.h5"
    ran = command("export", book, "--format", "c", "--prefix", "Bunch", "--self-test", "small", "-o", tuned / "st")
    assert ran.code == 0
    names = {name.replace("retarder", "bunch").replace("golden", "bunch_golden") for name in C_FILES}
    assert {Path(line).name for line in ran.out.splitlines()} == {*names, "bunch_configuration.toml"}
    # Tracks of an estimator are the same in every size.
    plain = ("export", measured_once / "book.h5", "--format", "c", "--self-test", "small", "-o", tmp_path / "small")
    assert command(*plain).code == 0
    small, full = ((at / "retarder_self_test.c").stat().st_size for at in (tmp_path / "small", measured_once / "c"))
    assert small < 0.5 * full
    for folder, prefix in (("st", "PARK"), ("st", "BUNCH")):
        ran = command("export", book, "--format", "st", "--prefix", prefix, "--split", "-o", tuned / folder)
        assert ran.code == 0
        assert Path(ran.out.splitlines()[0]).name == f"0001_{prefix}_TABLE.st"
    # The checker reads them all, whatever their names.
    ran = command("verify", tuned, "--json")
    assert {"st/bunch_table.c", "st/bunch_golden_vectors.csv", "c/retarder_table.c"} <= set(
        json.loads(ran.out)["files"]
    )
    assert {"st/0004_PARK_LOAD.st", "st/0004_BUNCH_LOAD.st"} <= set(json.loads(ran.out)["files"])
    assert json.loads(ran.out)["findings"] == []
    for name, old, new in (
        ("st/0004_PARK_LOAD.st", "MassOf : ARRAY[0..1] OF REAL := [2", "MassOf : ARRAY[0..1] OF REAL := [3"),
        ("st/0005_PARK_CHOOSE.st", "CategoryOf : ARRAY[0..1] OF INT := [1", "CategoryOf : ARRAY[0..1] OF INT := [2"),
        ("st/bunch_table.h", "CATEGORY_LS 2 ", "CATEGORY_LS 1 "),
    ):
        content = (tuned / name).read_text("ascii")
        (tuned / name).write_text(content.replace(old, new, 1), "ascii")
        assert content != (tuned / name).read_text("ascii")
    ran = command("verify", tuned)
    assert ran.code == 3
    assert "disagrees: st/0004_PARK_LOAD.st: masst of table 0 is " in ran.out
    assert "st/0004_PARK_LOAD.st: disagrees: CategoryOf stands there more than once, and differs" in ran.out
    assert "st/bunch_table.c: disagrees: its header defines the categories" in ran.out


@pytest.mark.parametrize(
    ("form", "options", "sentence"),
    [
        ("c", ("--prefix", "1st"), "--prefix 1st: the prefix is '1st', but it must have at most 10 Latin letters"),
        ("c", ("--self-test", "tiny"), "--self-test tiny: there is no such self-test; give full, small"),
        ("c", ("--split",), "--split is for --format st, not for c; leave it out"),
        ("scl", ("--split",), "--split is for --format st, not for scl; leave it out"),
        ("twincat", ("--prefix", "TRACK__2"), "--prefix TRACK__2: the prefix is 'TRACK__2', but it must have at most"),
        ("plcopen", ("--self-test", "tiny"), "--self-test tiny: there is no such self-test; give full, small"),
        (
            "json",
            ("--prefix", "A"),
            "--prefix is for --format c, st, plcopen, twincat, scl, fmu, not for json; leave it",
        ),
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


def test_plot_draws_without_solving(command: Command, tuned: Path, two_classes: Path, tmp_path: Path) -> None:
    ran = command("plot", tuned, "-o", tmp_path / "plots", "--config", two_classes, "--json")
    assert ran.code == 0
    names = {Path(name).name for name in json.loads(ran.out)["files"]}
    kinds = ("lines", "surfaces", "passes")
    assert names == {f"{i}-{kind}.svg" for i in (ID, HEAVIER) for kind in kinds}
    assert names == set(results_in(tmp_path / "plots"))
    without = command("plot", tuned / "tables" / f"{ID}.json", "-o", tmp_path / "bare")
    assert without.code == 0
    assert "no passes are drawn" in without.sentence
    assert len(results_in(tmp_path / "bare")) == 2


def test_init_prints_what_tune_reads(command: Command) -> None:
    ran = command("init", "--retarder", "t-50-bunch")
    assert ran.code == 0
    assert parse_config(ran.out, "out").retarder.name == "t-50-bunch"
    assert json.loads(command("init", "--json").out)["configuration"] == command("init").out
    assert "knp-5-bunch" in command("init", "--list").out
    assert "did you mean t-50-bunch?" in command("init", "--retarder", "t-50-bu").sentence


def test_init_prints_a_configuration_with_point_sensors(command: Command) -> None:
    bare, named = command("init", "--sensors"), command("init", "--sensors", "knp-5-bunch")
    assert [parse_config(ran.out, "out").retarder.name for ran in (bare, named)] == ["rnz-2m-dumper", "knp-5-bunch"]
    assert command("init", "--wheel-sensor").out.startswith("# A wheel sensor of retarder-synth")
    assert "did you mean knp-5-bunch?" in command("init", "--sensors", "knp-5").sentence
    assert "one file at a time" in command("init", "--sensors", "--sensor").sentence
