"""The commands `hump`: what they tell, what they write, what they refuse."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import synth
from plant_models.library.hump_schema import hump_schema
from synth.frame.faults import InputError
from tests.frame.small_command import results_in
from tests.plant_models.hump.random_humps import SMALL
from tests.system.conftest import Command


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "small.toml"
    path.write_text(SMALL)
    return path


def test_check_tells_what_is_there_and_what_is_missing(command: Command, file: Path) -> None:
    run = command("hump", "check", file, "--json")
    found = json.loads(run.out)
    assert (run.code, found["tracks"], found["switches"], found["retarders"]) == (0, 2, 1, 1)
    assert (found["retarders_with_book"], found["retarders_by_exit_std_m_s"]) == ([], {"0.15": [401]})
    assert found["retarders_without_aim_tables"] == [401]
    assert found["numbers"] == {"cited": 1, "assumed": 23, "without_source": 0}
    words = command("hump", "check", file).out
    assert "tracks: 2; switches: 1; retarder positions: 1" in words
    assert "retarders with a book of controller tables: none\n" in words
    assert "retarders without a book, standard deviation of their exit speeds 0.15 m/s: 401\n" in words


def test_a_named_book_must_be_there(command: Command, file: Path) -> None:
    file.write_text(SMALL.replace("exit_std_m_s = 0.15", 'book = "b.h5"\naim_tables = ["a.json"]'))
    run = command("hump", "check", file)
    assert run.code == 2
    assert run.err.splitlines() == [
        f"retarder-synth: {file}: retarder 401: {names}, and there is no such file; make it, or take it out"
        for names in ("book names b.h5", "aim_tables names a.json")
    ]
    file.with_name("b.h5").touch()
    file.with_name("a.json").touch()
    found = json.loads(command("hump", "check", file, "--json").out)
    assert (found["retarders_with_book"], found["retarders_by_exit_std_m_s"]) == ([401], {})
    assert found["retarders_without_aim_tables"] == []
    assert "retarders with a book of controller tables: 401\n" in command("hump", "check", file).out


def test_routes(command: Command, file: Path) -> None:
    found = json.loads(command("hump", "routes", file, "--json").out)
    assert [(route["track"], route["code"], route["length_m"]) for route in found["routes"]] == [
        (1, "0", 442.0),
        (2, "1", 402.0),
    ]
    assert found["switches"] == [{"number": 1, "name": None, "left_tracks": [1], "right_tracks": [2]}]
    first = found["routes"][0]["elements"]
    told = {"number": 1, "name": None, "at_m": 42.0, "section_m": [36.0, 47.0], "position": 0, "fouling_m": 68.0}
    assert first[1] == told
    lines = command("hump", "routes", file).out.splitlines()
    assert "signal 201, track 2, code 1: 201 0, 1 right 42, 602 102, end 402" in lines
    assert lines[-1] == "switch 1: left to tracks 1; right to tracks 2"


def test_draw(command: Command, file: Path, tmp_path: Path) -> None:
    run = command("hump", "draw", file, "-o", tmp_path / "out", "--track", "2", "--json")
    assert run.code == 0
    assert json.loads(run.out)["track"] == 2
    assert set(results_in(tmp_path / "out")) == {"small-hump.svg"}
    refused = command("hump", "draw", file, "-o", tmp_path / "none", "--track", "3")
    assert refused.code == 2
    assert refused.sentence == "--track is 3; the hump has the tracks 1 to 2"
    assert not (tmp_path / "none").exists()


def test_export_in_another_form_and_read_it(command: Command, file: Path, tmp_path: Path) -> None:
    target = tmp_path / "railml" / "small.railml"
    assert command("hump", "export", file, "--format", "railml", "-o", target.parent).out == f"{target}\n"
    assert command("hump", "routes", target).out == command("hump", "routes", file).out
    target.write_text(target.read_text().replace("<signalsIS>", "<speeds/><signalsIS>"))
    assert "read over: speeds (1)" in command("hump", "check", target).out
    for form in ("csv", "xlsx", "toml"):
        (written,) = json.loads(command("hump", "export", file, "--format", form, "-o", tmp_path / form, "--json").out)[
            "files"
        ]
        assert command("hump", "routes", written).out == command("hump", "routes", file).out
    refused = command("hump", "export", file, "--format", "txt", "-o", tmp_path / "txt")
    assert refused.sentence == "--format txt: there is no such form; give railml, csv, xlsx, toml"


def test_the_schema_is_printed(command: Command) -> None:
    assert json.loads(command("init", "hump", "--schema").out) == hump_schema()


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("bad.toml", SMALL.replace("to = 602", "to = 603"), "bad.toml, line 22: switch 1: an edge leads to 603"),
        ("bad.toml", SMALL + "[", "not valid TOML"),
        ("bad.toml", "", "key format is missing"),
        ("bad.railml", "<railML/>", "its root is railML"),
        ("bad.railml", "<a", "not valid XML"),
    ],
)
def test_a_bad_file_is_told_in_one_sentence(command: Command, tmp_path: Path, name: str, text: str, words: str) -> None:
    (tmp_path / name).write_text(text)
    for verb in ("check", "routes", "draw"):
        run = command("hump", verb, tmp_path / name)
        assert (run.code, run.out) == (2, "")
        assert words in run.sentence


def test_from_python(file: Path) -> None:
    assert synth.load_hump(file).graph.route(201, 1).code == "0"
    assert synth.load_hump("large").graph.tracks == tuple(range(1, 33))
    with pytest.raises(InputError, match="there is no such file, and no such hump in the library"):
        synth.load_hump("lage")
