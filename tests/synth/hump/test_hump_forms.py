"""Hump files: their forms, their names, and anything else in them.

A hump as a table for spreadsheets, and as TOML: both ways it stays the same, and faults have their lines.
Hump files with anything in them: read, or refused in one sentence; never another exception.
What a yard calls its switches, positions and tracks is told beside their numbers wherever these are told.
The page on hump files: its two files are read, and are what the text around them says.
"""

from __future__ import annotations

import csv
import io
import json
import random
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from plant_models.library.hump_entry import HumpEntry, hump_names, load_hump
from plant_models.library.library import BUILT_IN, HUMPS
from plant_models.library.toml_lines import places_of
from synth.cli import main
from synth.frame.faults import InputError
from synth.frame.sheet import first_sheet_csv
from synth.hump.hump_file import parse_hump
from synth.hump.hump_forms import from_csv, to_csv, to_xlsx, tree_toml
from synth.hump.making.make_command import hump_toml
from synth.hump.making.short_file import read_short_hump
from synth.hump.trains.hump_page.hump_page import plan_data, words
from synth.hump.trains.train_trace import Alarm, AlarmKind
from tests.effort import sized
from tests.plant_models.hump.random_humps import SMALL, random_hump
from tests.plant_models.hump.test_hump_file import LINES


def humps() -> list[HumpEntry]:
    """Those of the library, and random ones."""
    drawn = [
        HumpEntry(f"hump-{seed}", 'Drawn, "of many"; 1,5', (), random_hump(seed)) for seed in range(sized(30, 500))
    ]
    return [*map(load_hump, hump_names()), *drawn]


def for_excel(table: str) -> str:
    """As a spreadsheet saves it where numbers have decimal commas."""
    written = io.StringIO()
    rows = [[re.sub(r"^(-?\d+)\.(\d+)$", r"\1,\2", cell) for cell in row] for row in csv.reader(io.StringIO(table))]
    csv.writer(written, delimiter=";", lineterminator="\r\n").writerows(rows)
    return written.getvalue()


def test_a_hump_stays_the_same_in_every_form() -> None:
    for hump in humps():
        table = to_csv(hump)
        for again in (
            from_csv(table, hump.name, "x.csv"),
            from_csv(for_excel(table), hump.name, "x.csv"),
            parse_hump(tree_toml(hump), hump.name, "x.toml"),
        ):
            assert (again.graph, again.title, again.notes, again.cars) == (
                hump.graph,
                hump.title,
                hump.notes,
                hump.cars,
            )


@pytest.mark.parametrize("name", hump_names())
def test_a_hump_stays_the_same_in_a_workbook(name: str) -> None:
    hump = load_hump(name)
    again = from_csv(first_sheet_csv(to_xlsx(hump), "x.xlsx"), name, "x.xlsx")
    assert (again.graph, again.title, again.notes, again.cars) == (hump.graph, hump.title, hump.notes, hump.cars)


def test_all_faults_of_a_table_are_told_each_with_its_line() -> None:
    table = to_csv(parse_hump(SMALL, "small", "small.toml"))
    lines = table.splitlines()
    wrong = (
        table.replace("switch,,,1,", "switch,,,200,")
        .replace("knp-5-bunch", "knp")
        .replace(",0.6,", ",'fast',")
        .replace("section,,,602", "sektion,,,602")
    )
    with pytest.raises(InputError) as caught:
        from_csv(wrong, "small", "small.csv")
    for fault, kind in (
        ("switch 200: the number is not in its group", "switch"),
        ("switch 200: throw_s is 'fast'; it must be a finite number", "switch"),
        ("'knp' is not in the library; did you mean knp-5-bunch?", "retarder"),
        ("kind is 'sektion'; it must be one of hump, signal, switch, retarder, section", "section,,,602"),
    ):
        (sentence,) = (each for each in caught.value.sentences if fault in each)
        assert lines[int(sentence.split("line ")[1].split(":")[0]) - 1].startswith(kind)


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ("kind,nummer\nswitch,1\n", "x.csv, line 1: the column nummer is unknown; did you mean number?"),
        ("number\n1\n", "x.csv, line 1: the column kind is missing; it tells hump, signal, switch, retarder, section"),
        ("", "the column kind is missing"),
        ("kind,title\nhump,A\n", "leads must be a list of whole numbers"),
    ],
)
def test_what_is_no_table_of_a_hump(table: str, words: str) -> None:
    with pytest.raises(InputError) as caught:
        from_csv(table, "x", "x.csv")
    assert words in caught.value.sentences[0]


PIECES = (
    *("[", "]", "{", "}", "=", ",", ".", "#", '"', "'", '"""', "\n", "\\", "\x00", "é", "-", "1e999", "nan", "9" * 30),
    *(
        "true",
        "[hump]\n",
        "[[hump.switch]]\n",
        "[type.turnout]\n",
        "type = 'track'",
        "next = {}",
        "number = 601",
        "to = 1",
    ),
)


def changed(text: str, rng: random.Random) -> str:
    """`text` with one to four characters, lines or pieces taken away, added or exchanged."""
    for _ in range(rng.randint(1, 4)):
        at, to = sorted((rng.randrange(len(text) + 1), rng.randrange(len(text) + 1)))
        match rng.randrange(5):
            case 0:
                text = text[:at] + text[at + rng.randint(1, 3) :]
            case 1:
                text = text[:at] + rng.choice(PIECES) + text[at:]
            case 2:
                text = text[:at] + rng.choice(PIECES) + text[at + 1 :]
            case 3 if to - at < 80:
                text = text[:at] + text[to:]
            case _:
                digits = [place for place, sign in enumerate(text) if sign.isdigit()]
                if digits:
                    place = rng.choice(digits)
                    text = text[:place] + str(rng.randrange(1000)) + text[place + 1 :]
    return text


def places_in(tree: Any) -> Iterator[tuple[str | int, ...]]:
    """Every place of a tree that tomllib made."""
    items = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for key, value in items:
        yield (key,)
        yield from ((key, *below) for below in places_in(value))


def test_lines_are_found_of_all_that_tomllib_finds() -> None:
    rng, valid = random.Random(8), 0
    while valid < sized(250, 1000):
        text = changed(LINES if valid % 2 else SMALL, rng)
        try:
            tree = tomllib.loads(text)
        except (tomllib.TOMLDecodeError, RecursionError, ValueError):
            continue
        valid += 1
        found = places_of(text)
        assert set(found) == set(places_in(tree))
        for place, line in found.items():
            named = place[-1] if isinstance(place[-1], str) else None
            if named is not None and named.isidentifier():
                assert named in text.splitlines()[line - 1]


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


PAGE = (Path(__file__).parents[3] / "docs" / "reference" / "hump-file.md").read_text(encoding="utf-8")


def test_the_files_on_the_page() -> None:
    short, text = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    made = parse_hump(hump_toml(read_short_hump(short, "short.toml"), "short.toml"), "made", "made.toml")
    assert (len(made.graph.tracks), len(made.graph.switches)) == (16, 15)
    hump = parse_hump(text, "page", "page.toml")
    assert hump.graph.incidence[1] == (2, 3)
    assert [route.code for route in hump.graph.routes(201).values()] == ["00", "01", "10", "11"]
    assert hump.graph.route(201, 2).free_to_m == 40 + 34 + 34 + 400 - 120
    assert [each.exit_std_m_s for each in hump.graph.retarders] == [0.15]
    assert all(value.assumed or value.source.startswith("data sheet") for value in hump.provenance)
