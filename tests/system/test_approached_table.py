"""A table that acts before the entrance, told by the command line."""

from __future__ import annotations

import json
from pathlib import Path

from tests.controller_code.sample_book import FOUR_AXLES, table_of, with_approach
from tests.system.conftest import Command
from tuning_tables import write_json


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
        ("c", "retarder_table.h", "#define RETARDER_APPROACH 1u"),
        ("st", "retarder_table.st", "EntranceStageOf"),
        ("json", "one.json", '"version": 3'),
    ):
        run = command("export", tmp_path / "one.json", "--format", form, "-o", tmp_path / form)
        assert run.code == 0, run.err
        (written,) = (tmp_path / form).rglob(name)
        assert words in written.read_text(encoding="utf-8")
