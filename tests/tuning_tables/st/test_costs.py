"""The figures of docs/structured-text.md: operations executed by the parse tree, and bytes of its variables."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.storage import Array, Record, Scalar
from tuning_tables.st_source import SELF_TEST_FILE, TABLE_FILE, st_files
from tuning_tables.table_book import TableBook

PAGE = Path(__file__).parents[3] / "docs" / "structured-text.md"
BYTES = {"REAL": 4, "INT": 2, "BOOL": 1}


def stated(label):
    """The numbers in the row of the page that begins with `label`."""
    (row,) = re.findall(rf"^\| {re.escape(label)}[^|]*\|(.*)\|$", PAGE.read_text("utf-8"), re.MULTILINE)
    return [int(number.replace(" ", "")) for number in re.findall(r"\d[\d ]*", row)]


def executed(program, name, **arguments):
    """Operations of one call in all, and those on REAL among them."""
    instance = program.new(name)
    program.done.clear()
    program.call(name, instance, **arguments)
    return counted(program.done)


def counted(done):
    """Operations in all, and those on REAL."""
    return sum(done.values()), sum(count for kind, count in done.items() if kind.startswith("REAL"))


def size(kind):
    """Bytes of a variable without gaps."""
    if isinstance(kind, Scalar):
        return BYTES[kind.kind]
    if isinstance(kind, Array):
        return (kind.high - kind.low + 1) * BYTES[kind.element.kind]
    assert isinstance(kind, Record)
    return sum(size(member[0]) for member in kind.members.values())


@pytest.fixture(scope="module")
def program(default_book):
    return Program(st_files(default_book)[TABLE_FILE])


def test_operations_of_a_decision(program, default_book):
    worst = (0, 0)
    for number in range(len(default_book.tables)):
        table = program.new("RETARDER_TABLE")
        executed(program, "RETARDER_LOAD", TableNo=number, Table=table)
        for stage in range(5):
            for s in (-1.0, 10.0, 40.0):
                for v in np.float32([0.0, 2.0, 3.0, 4.0, 5.0, 9.0]):
                    worst = max(
                        worst, executed(program, "RETARDER_DECIDE", Stage=stage, Path_m=s, Speed_m_s=v, Table=table)
                    )
    assert stated("`RETARDER_DECIDE`") == list(worst)


def test_operations_of_a_choice(program, default_book):
    def choice(book, speed):
        each = Program(st_files(book)[TABLE_FILE])
        table = each.new("RETARDER_TABLE")
        return executed(each, "RETARDER_SELECT", Category=1, Axles=4, Commanded_m_s=speed, Table=table)

    tables = default_book.tables
    others = [replace(table, id=f"other {table.id}", cut=replace(table.cut, category="X")) for table in tables]
    twice = TableBook((*tables, *others))
    between, more = choice(default_book, 2.5), choice(twice, 2.5)
    assert stated("`RETARDER_SELECT`, between") == list(between)
    assert stated("`RETARDER_SELECT`, tuned") == list(choice(default_book, 3.0))
    assert stated("`RETARDER_SELECT`, each further") == [(more[0] - between[0]) // len(others), 0]
    assert (more[0] - between[0]) % len(others) == 0
    table = program.new("RETARDER_TABLE")
    assert stated("`RETARDER_LOAD`") == list(executed(program, "RETARDER_LOAD", TableNo=0, Table=table))


def test_operations_of_the_self_test(default_book):
    program = Program(b"".join(st_files(default_book).values()))
    instance, worst = program.new("RETARDER_SELF_TEST"), (0, 0)
    while not instance["DONE"].value:
        program.done.clear()
        program.call("RETARDER_SELF_TEST", instance, Restart=False)
        worst = max(worst, counted(program.done))
    assert stated("`RETARDER_SELF_TEST`") == list(worst)


def test_bytes(default_book):
    files = st_files(default_book)
    program = Program(files[TABLE_FILE] + files[SELF_TEST_FILE])
    few = Program(st_files(TableBook(default_book.tables[:5]))[TABLE_FILE])
    constants = sum(
        size(program.types[name]) - size(few.types[name]) for name in ("RETARDER_LOAD", "RETARDER_SELECT")
    ) - (size(program.types["RETARDER_LOAD"]) - size(few.types["RETARDER_LOAD"]))  # SELECT holds an instance of LOAD
    assert stated("one `RETARDER_TABLE`") == [size(program.types["RETARDER_TABLE"])]
    assert stated("constants of one table") == [constants]
    tests = [size(program.types[f"RETARDER_TEST_{number}"]) for number in range(len(default_book.tables))]
    assert stated("self-test of one table") == [min(tests), max(tests)]
