"""What a yard calls its switches, positions and tracks is told beside their numbers wherever these are told."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from plant_models.library.library import BUILT_IN
from plant_models.library.type_file import HUMPS
from synth.cli import main
from synth.frame.input_error import InputError
from synth.hump.hump_file import parse_hump
from synth.hump.trains.hump_page.plan_data import plan_data
from synth.hump.trains.hump_page.train_data import words
from synth.hump.trains.train_trace import Alarm, AlarmKind

NAMES = {"number = 1, ": "East 4", "number = 401, ": "Master", "number = 605, ": "C12"}


def named() -> str:
    """The medium hump with some names."""
    text = BUILT_IN.file(HUMPS, "medium").text
    for row, name in NAMES.items():
        assert text.count(row) == 1
        text = text.replace(row, f'{row}name = "{name}", ')
    return text


def test_names_are_told_beside_numbers(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "named.toml"
    file.write_text(named(), encoding="utf-8")
    assert main(["hump", "routes", str(file)]) == 0
    routes = capsys.readouterr().out
    assert "track 5 (C12), code" in routes
    assert "1 (East 4) left" in routes
    assert "switch 1 (East 4): left to tracks 1 to 8" in routes
    assert main(["hump", "check", str(file), "--json"]) == 0
    places = json.loads(capsys.readouterr().out)["places"]
    told = {row["kind"]: row["names"] for row in places if row["names"]}
    assert told == {"switch": ["1: East 4"], "retarder": ["401: Master"], "track": ["5: C12"]}
    assert main(["hump", "routes", str(file), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["switches"][0]["name"] == "East 4"
    graph = parse_hump(named(), "named", str(file)).graph
    assert plan_data(graph, {})["tracks_called"]["5"] == "5 (C12)"
    alarm = Alarm(AlarmKind.MISROUTED, 1.0, 3, 2, 1)
    assert words(alarm, graph) == "cut 4 misrouted behind cut 3 at switch 1 (East 4)"


def test_a_message_about_a_row_tells_its_name() -> None:
    with pytest.raises(InputError) as caught:
        parse_hump(named().replace('name = "C12", ', 'name = "C12", standing_m = 7000, '), "named", "named.toml")
    assert "section 605 (C12): standing_m is 7000" in str(caught.value)
