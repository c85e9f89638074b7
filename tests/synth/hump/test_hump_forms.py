"""A hump as a table for spreadsheets, and as TOML: both ways it stays the same, and faults have their lines."""

from __future__ import annotations

import csv
import io
import re

import pytest

from plant_models.library.hump_entry import HumpEntry, hump_names, load_hump
from synth.frame.input_error import InputError
from synth.frame.workbook import first_sheet_csv
from synth.hump.forms.hump_csv import from_csv, to_csv, to_xlsx
from synth.hump.forms.hump_tree import tree_toml
from synth.hump.hump_file import parse_hump
from tests.effort import sized
from tests.plant_models.hump.random_humps import SMALL, random_hump


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
    for words, kind in (
        ("switch 200: the number is not in its group", "switch"),
        ("switch 200: throw_s is 'fast'; it must be a finite number", "switch"),
        ("'knp' is not in the library; did you mean knp-5-bunch?", "retarder"),
        ("kind is 'sektion'; it must be one of hump, signal, switch, retarder, section", "section,,,602"),
    ):
        (sentence,) = (each for each in caught.value.sentences if words in each)
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
