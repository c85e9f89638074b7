"""Two positions in one C program; classes added, removed, reordered: the others keep numbers and choices."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from scripts.studies.in_the_loop.agreement import Questions, Tracks, ask, differences, follow
from scripts.studies.in_the_loop.controller_process import COMMAND, CONTRACT, Controller, compile_with
from scripts.studies.in_the_loop.held_words import table_words
from synth.retarder.configuration.config_file import parse_config
from tests.controller_code.conftest import Tool
from tests.controller_code.sample_book import FOUR_AXLES, estimating_book, park_book, sample_book, table_of
from tests.st_files import st_files
from tuning_tables import ControllerTable
from tuning_tables.c_source import c_files
from tuning_tables.category_names import category_names
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.golden_choices import golden_choices
from tuning_tables.plc_forms.iec import unit_files
from tuning_tables.self_test_size import FULL, SMALL
from tuning_tables.st_source import line_export
from tuning_tables.table_book import TableBook

POSITIONS = {"bunch": estimating_book(), "park": park_book()}
MAIN = """
#include <string.h>
#include "bunch_self_test.h"
#include "park_self_test.h"
int bunch_main(int count, char **arguments);
int park_main(int count, char **arguments);
int main(int count, char **arguments)
{
    /* Categories are the same for both; tables are of two types. */
    if (BUNCH_CATEGORY_ST != PARK_CATEGORY_ST || sizeof(bunch_table) == sizeof(park_table) || count < 3) {
        return 6;
    }
    return strcmp(arguments[1], "bunch") == 0 ? bunch_main(count - 1, arguments + 1)
                                              : park_main(count - 1, arguments + 1);
}
"""


def both_in_one(folder: Path, small: bool) -> Path:
    """A program that holds both controllers, each with a process around it (`scripts.studies.in_the_loop`)."""
    around = (files("scripts.studies.in_the_loop") / "controller_process.c").read_text("ascii")
    objects = []
    for name, book in POSITIONS.items():
        prefix = ExportPrefix(name.upper())
        sources = dict(c_files(book, prefix, SMALL if small else FULL))
        for file, content in sources.items():
            (folder / file).write_bytes(content)
        (folder / f"{name}_process.c").write_text(prefix.renamed(around), "ascii")
        for file in (f"{name}_table.c", f"{name}_self_test.c"):
            objects.append(str(folder / f"{file}.o"))
            compile_with(["gcc", *CONTRACT, "-O2", "-c", str(folder / file), "-o", objects[-1]])
        objects.append(str(folder / f"{name}_process.o"))
        process = str(folder / f"{name}_process.c")
        compile_with(["gcc", "-O2", f"-Dmain={name}_main", "-c", process, "-o", objects[-1]])
    (folder / "main.c").write_text(MAIN, "ascii")
    compile_with(["gcc", *CONTRACT[:-1], str(folder / "main.c"), *objects, "-o", str(folder / "both")])
    return folder / "both"


@pytest.fixture(scope="module")
def compiled(tmp_path_factory: pytest.TempPathFactory, tool: Tool) -> Callable[[bool], Path]:
    """`both_in_one` with the full or the small self-test, each compiled once."""

    @cache
    def program(small: bool) -> Path:
        tool("gcc")
        return both_in_one(tmp_path_factory.mktemp("both"), small)

    return program


@cache
def asked(name: str) -> tuple[Questions, Tracks]:
    """What the controller of a position is asked, and what Python answers."""
    return ask(POSITIONS[name], 100_000, 5_000, 7), follow(POSITIONS[name], 20_000, 8)


@pytest.mark.requirement("CODE-09")
@pytest.mark.parametrize("small", [False, True], ids=["full", "small"])
def test_both_answer_as_alone(small: bool, compiled: Callable[[bool], Path]) -> None:
    program = compiled(small)
    for name, book in POSITIONS.items():
        controller = Controller((str(program), name), table_words(book))
        assert controller.self_test() == "fault 0 at 0"
        assert differences(controller, *asked(name)).none


def test_every_name_that_the_linker_sees_has_the_prefix(compiled: Callable[[bool], Path]) -> None:
    folder = compiled(True).parent
    for name in POSITIONS:
        listed = compile_with(["nm", "-g", "--defined-only", str(folder / f"{name}_table.c.o")])
        names = [line.split()[-1] for line in listed.splitlines() if len(line.split()) == 3]
        assert len(names) > 8
        assert all(each.startswith(f"{name}_") for each in names)


def split_files(book: TableBook, prefix: ExportPrefix = RETARDER) -> Mapping[str, bytes]:
    """Structured Text with a file each unit."""
    return unit_files(line_export(book, prefix))


@pytest.mark.parametrize("export", [c_files, st_files, split_files])
def test_the_default_prefix_changes_no_byte(export: Callable[..., Mapping[str, bytes]]) -> None:
    for book in POSITIONS.values():
        assert export(book, ExportPrefix("retarder")) == export(book)


@pytest.mark.parametrize("export", [c_files, st_files, split_files])
def test_every_name_has_the_prefix_and_no_comment_loses_an_id(export: Callable[..., Mapping[str, bytes]]) -> None:
    book = sample_book()
    odd = replace(book.tables[0], id="RETARDER_LOAD retarder_x")
    plain, named = (export(TableBook((odd, *book.tables[1:])), prefix) for prefix in (ExportPrefix(), PARK))
    assert list(named) == [name.replace("retarder_", "park_2_").replace("RETARDER_", "PARK_2_")
                           .replace("golden_", "park_2_golden_") for name in plain]  # fmt: skip
    for before, after in zip(plain.values(), named.values(), strict=True):
        assert b"RETARDER<U+005F>LOAD retarder<U+005F>x" in before or b"0: RETARDER" not in before
        if before != after:  # tables as CSV have no names
            assert not re.search(rb"(?i)\bretarder_", after)
            back = re.sub(rb"\bPARK_2_", b"RETARDER_", re.sub(rb"\bpark_2_", b"retarder_", after))
            assert back == before


PARK = ExportPrefix("Park_2")


@pytest.mark.parametrize("text", ["", "1A", "A B", "_A", "A_", "A__B", "ПАРК", "A-B", "ABCDEFGHIJK", "A\n"])
def test_what_is_no_identifier_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"the prefix is .* such as BUNCH"):
        ExportPrefix(text)


MASSES = {"Л": 23.0, "ЛС": 36.0, "С": 52.0, "СТ": 66.0, "Т": 85.0}
FIXED = {"Л": 1, "ЛС": 2, "С": 3, "СТ": 4, "Т": 5, "own": 16}


def tables(category: str) -> tuple[ControllerTable, ...]:
    """Two targets of one class; the lines differ from class to class."""
    mass_t = MASSES.get(category, 40.0)
    made = []
    for target in (2.0 + mass_t / 1000.0, 3.0 + mass_t / 1000.0):
        table = table_of(f"{category} to {target}", category, mass_t, FOUR_AXLES, target)
        number = None if category in MASSES else 16
        made.append(replace(table, cut=replace(table.cut, category_number=number)))
    return tuple(made)


def book(*categories: str) -> TableBook:
    return TableBook(tuple(table for category in categories for table in tables(category)))


BEFORE = ("Л", "С", "Т")
AFTER = [
    ("Т", "С", "Л"),
    ("С", "Т", "Л"),
    ("Л", "ЛС", "С", "СТ", "Т"),
    ("own", "СТ", "Т", "ЛС", "С", "Л"),
    ("Т",),
    ("Т", "Л"),
]
"""Reordered, with classes added before, between and behind, with classes removed."""


def choices_by_class(of: TableBook) -> dict[int, list[tuple[object, ...]]]:
    """By number of the category the golden choices with a table: command, status, target speed and coefficients."""
    found: dict[int, list[tuple[object, ...]]] = {}
    for choice in golden_choices(of):
        if choice.table is not None:
            chosen = choice.table.target_speed_m_s, choice.table.coefficients.tobytes()
            found.setdefault(choice.category, []).append((choice.commanded_m_s, choice.status, *chosen))
    return found


@pytest.mark.parametrize("after", AFTER, ids="-".join)
def test_numbers_and_golden_choices_stay(after: tuple[str, ...]) -> None:
    first, second = book(*BEFORE), book(*after)
    assert dict(second.category_numbers) == {category: FIXED[category] for category in after}
    assert {*category_names(first.exported_numbers())} <= {*category_names(second.exported_numbers())}
    before, now = choices_by_class(first), choices_by_class(second)
    assert set(now) == {FIXED[category] for category in after}
    for category in {*BEFORE} & {*after}:
        assert before[FIXED[category]] == now[FIXED[category]]
        assert len(now[FIXED[category]]) > 5


def commands() -> np.ndarray:
    """Every number from 0 to 17 at speeds around all targets."""
    speeds = np.linspace(1.9, 3.3, 141, dtype=np.float32).tolist()
    exact = [table.target_speed_m_s for category in FIXED for table in tables(category)]
    rows = [(number, 4, speed) for number in range(18) for speed in (*speeds, *exact)]
    return np.array(rows, COMMAND)


CUT = """
[[cut]]
car = "gondola-4"
mass_t = {}
"""


@pytest.mark.parametrize("order", [(22, 85), (85, 22), (85, 52, 22), (36, 85, 22)])
def test_the_order_of_a_configuration_does_not_count(order: tuple[int, ...]) -> None:
    config = parse_config("".join(map(CUT.format, order)), "my.toml")
    numbers = {22: 1, 36: 2, 52: 3, 85: 5}
    assert [each.cut.category_number for each in config.cuts] == [numbers[mass_t] for mass_t in order]
    # It is no physics: what was computed before stays valid.
    assert all("category_number" not in each.canonical() for each in config.cuts)
