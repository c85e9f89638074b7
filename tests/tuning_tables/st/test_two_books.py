"""Two positions in one project of Structured Text: one text, both books in it, each answering as alone."""

from __future__ import annotations

import re

import pytest

from tests.controller_code.sample_book import estimating_book, park_book
from tests.st_files import st_files
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.syntax import faults, parse
from tests.tuning_tables.st.test_self_test import MOST_CALLS
from tuning_tables.export_prefix import ExportPrefix
from tuning_tables.plc_forms.iec import Layout, part_files, unit_files
from tuning_tables.self_test_size import SMALL, SelfTestSize
from tuning_tables.st_source import line_export

POSITIONS = {"BUNCH": estimating_book(), "PARK": park_book()}


def project(self_test: SelfTestSize, layout: Layout = part_files) -> bytes:
    """The files of both, one after the other."""
    return b"\n".join(
        text
        for name, book in POSITIONS.items()
        for text in layout(line_export(book, ExportPrefix(name), self_test)).values()
    )


def units_in(text: bytes) -> list[bytes]:
    """The names of all blocks and types."""
    return [b"".join(found) for found in re.findall(rb"^FUNCTION_BLOCK (\w+)$|^ +(\w+) : STRUCT$", text, re.MULTILINE)]


@pytest.fixture(scope="module")
def text() -> bytes:
    return project(SMALL)


def test_it_is_one_text_without_a_name_twice(text: bytes) -> None:
    assert faults(parse(text)) == []
    names = units_in(text)
    assert len(names) == len(set(names)) > 40
    assert {name.partition(b"_")[0] for name in names} == {b"BUNCH", b"PARK"}
    assert b"RETARDER_" not in text


def test_both_self_tests_find_nothing(text: bytes) -> None:
    program = Program(text)
    for name in POSITIONS:
        instance = program.new(f"{name}_SELF_TEST")
        for _ in range(MOST_CALLS):
            program.call(f"{name}_SELF_TEST", instance, Restart=False)
        assert (instance["DONE"].value, instance["FAILED"].value) == (True, 0)


def test_split_files_in_the_order_of_their_names_are_the_same_program() -> None:
    for name, book in POSITIONS.items():
        whole, units = (layout(line_export(book, ExportPrefix(name))) for layout in (part_files, unit_files))
        assert list(units) == sorted(units)
        assert len(units) > 15
        for file, unit in units.items():
            assert [file[5:-3].encode()] == units_in(unit)
            assert faults(parse(unit)) == []
        comments = rb"\(\* Self-test of .*?\*\)\n\n"
        joined = b"\n".join(whole.values())
        assert re.sub(comments, b"", joined, count=1, flags=re.DOTALL) == b"\n".join(units.values())
    Program(project(SMALL, unit_files))


def test_the_longest_names_stay_within_32_characters() -> None:
    for text in st_files(POSITIONS["BUNCH"], ExportPrefix("ABCDEFGHIJ")).values():
        assert max(map(len, re.findall(rb"\bABCDEFGHIJ_\w+", text))) <= 32
