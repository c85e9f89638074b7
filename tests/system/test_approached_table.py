"""A table that acts before the entrance, told by the command line."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

from tests.controller_code.sample_book import FOUR_AXLES, table_of, with_approach
from tests.system.conftest import Command
from tuning_tables import read_json, write_json


def test_inspect_tells_the_approach_and_its_interlock(command: Command, tmp_path: Path) -> None:
    plain = table_of("one", "Л", 23.0, FOUR_AXLES, 2.0)
    write_json(plain, tmp_path / "plain.json")
    write_json(with_approach(plain, 4.0, 1), tmp_path / "approached.json")
    told = command("inspect", tmp_path / "approached.json").out
    assert "acts from 4 m before the entrance on, where it commands no stage above 1;" in told
    assert "only when the cut ahead has left the position" in told
    assert "path -4 to 37.45 m" in told
    assert "approach" not in command("inspect", tmp_path / "plain.json").out.replace("approached.json", "")
    as_json = json.loads(command("inspect", tmp_path / "approached.json", "--json").out)
    (table,) = as_json["files"][0]["tables"]
    assert table["approach"] == {"length_m": 4.0, "entrance_stage": 1, "interlock": "position_clear"}
    assert table["lines_at"][0]["v_m_s"]


def test_every_form_of_export_holds_it(command: Command, tmp_path: Path) -> None:
    write_json(with_approach(table_of("one", "Л", 23.0, FOUR_AXLES, 2.0), 4.0, 1), tmp_path / "one.json")
    for form, name, words in (
        ("csv", "one.csv", "number,approach.entrance_stage,1"),
        ("csv", "one.csv", "text,approach.interlock,position_clear"),
        ("c", "retarder_table.c", "1, /* entrance_stage */"),
        ("st", "retarder_table.st", "EntranceStageOf"),
        ("json", "one.json", '"interlock": "position_clear"'),
    ):
        run = command("export", tmp_path / "one.json", "--format", form, "-o", tmp_path / form)
        assert run.code == 0, run.err
        (written,) = (tmp_path / form).rglob(name)
        assert words in written.read_text(encoding="utf-8")


def test_a_table_of_before_is_told_which_key_it_needs(
    command: Command, tuned: Path, two_classes: Path, tmp_path: Path
) -> None:
    assert "approach_m" not in two_classes.read_text(encoding="utf-8")
    table = read_json(tuned / "tables" / "gondola-4-22t-to-1.5-m-s.json")
    path, config = tmp_path / "before.json", tmp_path / "with_the_key.toml"
    write_json(replace(table, approach=None, valid=replace(table.valid, s_m=(0.0, table.valid.s_m[1]))), path)
    ran = command("validate", path, "--config", two_classes, "--passes", "1000", "-o", tmp_path / "out")
    assert ran.code == 2
    assert "differs in regulator.approach_m (4, in the table 0)" in ran.sentence
    assert ran.sentence.endswith("by --config, with regulator.approach_m = 0 in it if it names none")
    config.write_text(two_classes.read_text(encoding="utf-8") + "[regulator]\napproach_m = 0.0\n", encoding="utf-8")
    assert "rms" in command("validate", path, "--config", config, "--passes", "1000", "-o", tmp_path / "out").out


def test_an_approach_that_makes_every_cut_faster_is_one_sentence(
    command: Command, two_classes: Path, tmp_path: Path
) -> None:
    config, steep = tmp_path / "steep.toml", "[regulator]\napproach_m = 100.0\n[track]\ngrade_permille = 30.0\n"
    config.write_text(two_classes.read_text(encoding="utf-8") + steep, encoding="utf-8")
    ran = command("tune", config, "-o", tmp_path / "out")
    assert ran.code == 2
    assert "steep.toml: regulator.approach_m is 100; there the grade alone brings each cut to 7." in ran.sentence
    assert ran.sentence.endswith("raise that speed (cut class gondola-4-22t)")


def test_a_wrong_initial_stage_names_the_class_that_forbids_it(
    command: Command, two_classes: Path, tmp_path: Path
) -> None:
    config, classes = tmp_path / "closed.toml", two_classes.read_text(encoding="utf-8") + "entrance_stage = 1\n"
    for stage, told in (
        (2, "from 0 to the stage allowed at the entrance, 1 (cut class gondola-4-30t)"),
        (-1, "from 0 to 31"),
    ):
        config.write_text(f"{classes}[regulator]\ninitial_stage = {stage}\n", encoding="utf-8")
        ran = command("tune", config, "-o", tmp_path / "out")
        assert ran.code == 2
        assert ran.sentence.endswith(f"regulator.initial_stage is {stage}; it must be a whole number {told}")
