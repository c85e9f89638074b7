"""Two positions in one C program, each under its prefix: each answers as it does alone."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from importlib.resources import files
from pathlib import Path

import pytest

from scripts.studies.in_the_loop.agreement import Questions, Tracks, ask, differences, follow
from scripts.studies.in_the_loop.controller_process import CONTRACT, Controller, compile_with
from scripts.studies.in_the_loop.held_words import table_words
from tests.controller_code.conftest import Tool
from tests.controller_code.sample_book import estimating_book, park_book, sample_book
from tests.st_files import st_files
from tuning_tables.c_source import c_files
from tuning_tables.export_prefix import RETARDER, ExportPrefix
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
