"""inspect, export and verify of aim tables: output, exit codes, and what they refuse in one sentence."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from synth.cli.inspect_table import told_document
from synth.retarder.forms.code_options import CODE_NAMES
from tests.controller_code.sample_book import FOUR_AXLES, table_of
from tests.frame.small_command import results_in
from tests.st_files import aim_st_files
from tests.system.conftest import Command
from tests.system.test_start_up import HEAVY, modules_after
from tests.tuning_tables.aim.made_tables import category_table, measured_table, reported_of
from tuning_tables.aim import ParkPosition
from tuning_tables.aim.aim_tables import AimTables
from tuning_tables.aim.exports import aim_c_files, aim_export
from tuning_tables.csv_file import to_csv
from tuning_tables.export_names import RETARDER, ExportPrefix
from tuning_tables.json_file import to_json, write_json
from tuning_tables.language.st_layout import unit_files
from tuning_tables.self_test_size import SMALL

TABLES = (category_table(1.0), measured_table(), category_table(1.5, 4, "СТ"))
IN_ORDER = AimTables(TABLES)


@pytest.fixture
def aims(tmp_path: Path) -> Path:
    """A directory with tables/, whose file names are in another order than the categories."""
    folder = tmp_path / "aims"
    (folder / "tables").mkdir(parents=True)
    for name, table in zip("cba", TABLES, strict=True):
        write_json(table, folder / "tables" / f"{name}.json")
    return folder


def test_inspect_tells_the_contents(command: Command, aims: Path) -> None:
    ran = command("inspect", aims)
    assert ran.code == 0
    for words in (
        "c.json: an aim table; its CRC-32 is right",
        "aim-1-category: couple faster than 1.39 m/s with a probability of 0.1",
        "position   rnz-2m-park, left 338 m from the crest",
        "cuts       category Л (number 1), known by category and number of cars",
        "resistance measured from 228 to 338 m by two speeds +-0.03 m/s",
        "over-speed 0.0990 on average, at most 0.0990 [0.0950, 0.1030], mean gap 0.0 to 6.0 m; 20000 passes",
        "5 x 7, free distance 20 to 400 m; 1 of 35 have no exit speed, between them at most 0.012 m/s too slow",
        "8 cars, 1.5 N/kN",
    ):
        assert words in ran.out
    lines = command("inspect", aims / "tables" / "c.json").out.splitlines()
    shown = next(line for line in lines if line.startswith("1 car  ")).split()[2:]
    speeds = TABLES[0].exit_speed_m_s[0, [0, 1, 2, 4, 5, 6]]
    assert shown == [*(f"{speed:.3f}" for speed in speeds[:-1]), "none"]
    found = json.loads(command("inspect", aims / "tables" / "b.json", "--json").out)["files"]
    assert found == [
        {"path": str(aims / "tables" / "b.json"), "kind": "aim table", "checksum": "right",
         "tables": [told_document(TABLES[1])]}
    ]  # fmt: skip


def test_plot_draws_the_speeds_and_no_loop_is_closed(command: Command, aims: Path, tmp_path: Path) -> None:
    ran = command("inspect", aims, "-o", tmp_path / "plots")
    assert ran.code == 0
    pictures = {path.name for path in (tmp_path / "plots").glob("aim-*")}
    assert pictures == {f"aim-commands-by-{what}.svg" for what in ("cars", "resistance")}
    assert all((tmp_path / "plots" / name).stat().st_size > 5000 for name in pictures)
    for words, rest in (
        (("loop",), "give those of a tune"),
        (("validate",), "'aim' simulates what it makes"),
    ):
        assert refused(command, *words, aims, "-o", tmp_path / words[0]) == (
            2, f"{aims}: its tables are aim tables, which regulate nothing; {rest}",
        )  # fmt: skip


def test_a_table_without_any_speed_is_told(command: Command, tmp_path: Path) -> None:
    nothing = np.full_like(TABLES[0].exit_speed_m_s, np.nan)
    table = replace(TABLES[0], exit_speed_m_s=nothing, reported=reported_of(nothing))
    write_json(table, tmp_path / "aim.json")
    ran = command("inspect", tmp_path)
    assert ran.code == 0
    assert "reported   nothing: no node has figures" in ran.out
    assert "35 of 35 have no exit speed" in ran.out


def test_inspect_and_verify_need_nothing_heavy(aims: Path) -> None:
    assert modules_after(["inspect", str(aims)]).isdisjoint(HEAVY)


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        (("--format", "c"), lambda: aim_c_files(IN_ORDER)),
        (("--format", "c", "--prefix", "Park", "--self-test", "small"),
         lambda: aim_c_files(IN_ORDER, ExportPrefix("Park"), SMALL)),
        (("--format", "st"), lambda: aim_st_files(IN_ORDER)),
        (("--format", "st", "--split", "--self-test", "small"),
         lambda: unit_files(aim_export(IN_ORDER, RETARDER, SMALL))),
        (("--format", "json"), lambda: {f"{table.id}.json": to_json(table) for table in TABLES}),
        (("--format", "csv"), lambda: {f"{table.id}.csv": to_csv(table) for table in TABLES}),
    ],
)  # fmt: skip
def test_export_of_a_directory(
    command: Command, aims: Path, tmp_path: Path, options: tuple[str, ...], expected: Callable[[], dict[str, bytes]]
) -> None:
    ran = command("export", aims, *options, "-o", tmp_path / "new", "--json")
    assert ran.code == 0
    files = results_in(tmp_path / "new")
    assert files == expected()
    assert {Path(name).name for name in json.loads(ran.out)["files"]} == set(files)


def test_export_of_one_file(command: Command, aims: Path, tmp_path: Path) -> None:
    assert command("export", aims / "tables" / "c.json", "--format", "c", "-o", tmp_path / "c").code == 0
    assert (tmp_path / "c" / "aim_table.c").read_bytes() == aim_c_files(AimTables(TABLES[:1]))["aim_table.c"]


def test_verify_reads_what_export_writes(command: Command, aims: Path) -> None:
    for form in CODE_NAMES:
        assert command("export", aims, "--format", form, "--prefix", "PARK", "-o", aims / form).code == 0
    assert command("export", aims, "--format", "csv", "-o", aims / "csv").code == 0
    for file in (aims / "csv").glob("*.csv"):
        file.rename(aims / "tables" / file.name)
    ran = command("verify", aims)
    assert (ran.code, ran.err) == (0, "")
    assert ran.out.splitlines()[-1] == "accepted: 3 tables, 12 files: nothing found"
    told = command("inspect", aims)
    named = (
        ("c/park_aim_table.c", "C99"),
        ("st/park_aim_table.st", "Structured Text"),
        ("plcopen/park_aim_table.xml", "PLCopen XML"),
        ("twincat/PARK_AIM_LOAD.TcPOU", "Structured Text for TwinCAT"),
        ("scl/park_aim_table.scl", "SCL"),
    )
    code_lines = [line for line in told.out.splitlines() if "verify compares them" in line]
    for line, (name, language) in zip(code_lines, named, strict=True):
        assert line.startswith(f"{aims / name}: aim tables in {language}, exported by retarder-synth ")
    assert command("inspect", aims / "c" / "park_aim_table.c").code == 0
    code = aims / "c" / "park_aim_table.c"
    code.write_text(code.read_text().replace("{1, 2, 3, 5, 8}", "{1, 2, 3, 5, 9}", 1))
    ran = command("verify", aims)
    assert ran.code == 3
    assert "c/park_aim_table.c: cars[4] of table 0 is 9" in ran.out


def refused(command: Command, *arguments: object) -> tuple[int, str]:
    ran = command(*arguments)
    assert ran.out == ""
    assert ran.err.count("\n") == 1
    return ran.code, ran.sentence


def test_damage_and_faults_of_use_are_told_in_one_sentence(command: Command, aims: Path, tmp_path: Path) -> None:
    bad = aims / "tables" / "c.json"
    bad.write_bytes(bad.read_bytes().replace(b"0.012", b"0.013"))
    for words in (("inspect", aims), ("export", aims, "--format", "c", "-o", tmp_path / "x")):
        code, sentence = refused(command, *words)
        assert code == 3
        assert sentence.startswith(f"{bad}: crc32 is ")
    write_json(replace(TABLES[0], position=ParkPosition("other", 1.0)), bad)
    code, sentence = refused(command, "export", aims, "--format", "st", "-o", tmp_path / "x")
    assert code == 2
    assert "or they end elsewhere, but a set serves one position: export them apart" in sentence
    write_json(replace(TABLES[2], id="СТ"), bad)
    code, sentence = refused(command, "export", aims, "--format", "c", "-o", tmp_path / "x")
    assert code == 2
    assert "are both for the category СТ by it alone" in sentence
    code, sentence = refused(command, "export", aims, "--format", "c", "--prefix", "Park_AIM", "-o", tmp_path / "x")
    assert (code, "must not end with AIM" in sentence) == (2, True)
    (tmp_path / "empty").mkdir()
    assert refused(command, "export", tmp_path / "empty", "--format", "c")[0] == 2
    for source in (aims, aims / "tables" / "b.json"):
        assert refused(command, "loop", source, "-o", tmp_path / "x")[0] == 2
    assert not (tmp_path / "x").exists()


def test_tables_of_both_kinds_in_one_directory(command: Command, aims: Path, tmp_path: Path) -> None:
    """Commands for controller tables leave aim tables alone; inspect tells both; export of a directory is of aims."""
    write_json(table_of("own", "Л", 22.0, FOUR_AXLES, 2.0), aims / "tables" / "own.json")
    ran = command("inspect", aims, "--json")
    assert [file["kind"] for file in json.loads(ran.out)["files"]] == ["table", "aim table", "aim table", "aim table"]
    assert command("export", aims, "--format", "csv", "-o", tmp_path / "csv").code == 0
    assert len(results_in(tmp_path / "csv")) == 3
    assert command("verify", aims).out.splitlines()[-1] == "accepted: 4 tables, 4 files: nothing found"
