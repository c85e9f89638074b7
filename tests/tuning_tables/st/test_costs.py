"""The figures of docs/structured-text.md: operations executed by the parse tree, and bytes of its variables."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.controller_code.sample_book import estimator_of, with_approach, with_slopes
from tests.tuning_tables.st.conftest import texts_of
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.storage import Array, Kind, Record, Scalar, Value
from tuning_tables import ControllerTable, Decisions
from tuning_tables.golden_tracks import golden_tracks
from tuning_tables.self_test_size import FULL, SMALL
from tuning_tables.st_source import TABLE_FILE
from tuning_tables.table_book import TableBook

PAGE = Path(__file__).parents[3] / "docs" / "structured-text.md"
BYTES = {"REAL": 4, "INT": 2, "BOOL": 1}


def stated(label: str) -> list[int]:
    """The numbers in the row of the page that begins with `label`."""
    (row,) = re.findall(rf"^\| {re.escape(label)}[^|]*\|(.*)\|$", PAGE.read_text("utf-8"), re.MULTILINE)
    return [int(number.replace(" ", "")) for number in re.findall(r"\d[\d ]*", row)]


def executed(program: Program, name: str, **arguments: Value) -> tuple[int, int]:
    """Operations of one call in all, and those on REAL among them."""
    instance = program.new(name)
    program.done.clear()
    program.call(name, instance, **arguments)
    return counted(program.done)


def counted(done: Counter[str]) -> tuple[int, int]:
    """Operations in all, and those on REAL."""
    return sum(done.values()), sum(count for kind, count in done.items() if kind.startswith("REAL"))


def size(kind: Kind) -> int:
    """Bytes of a variable without gaps."""
    if isinstance(kind, Scalar):
        return BYTES[kind.kind]
    if isinstance(kind, Array):
        return (kind.high - kind.low + 1) * BYTES[kind.element.kind]
    assert isinstance(kind, Record)
    return sum(size(member[0]) for member in kind.members.values())


@pytest.fixture(scope="module")
def program(default_book: TableBook) -> Program:
    return Program(texts_of(default_book)[TABLE_FILE])


def dearest_decision(program: Program, tables: int, **pressure: Value) -> list[int]:
    """Operations of the dearest decision, and those on REAL among them."""
    worst = (0, 0)
    for number in range(tables):
        table = program.new("RETARDER_TABLE")
        executed(program, "RETARDER_LOAD", TableNo=number, Table=table)
        for stage in range(5):
            for s in (-1.0, 10.0, 40.0):
                for v in np.array([0.0, 2.0, 3.0, 4.0, 5.0, 9.0], np.float32):
                    asked = {"Stage": stage, "Path_m": s, "Speed_m_s": v, "Table": table, **pressure}
                    worst = max(worst, executed(program, "RETARDER_DECIDE", **asked))
    return list(worst)


def test_operations_of_a_decision(program: Program, default_book: TableBook) -> None:
    assert stated("`RETARDER_DECIDE`") == dearest_decision(program, len(default_book.tables))


def test_costs_of_slopes(program: Program, default_book: TableBook) -> None:
    sloped = Program(texts_of(sloped_book(default_book.tables))[TABLE_FILE])
    costs = [dearest_decision(sloped, len(default_book.tables), Pressure_kpa=np.float32(kpa)) for kpa in (-9.0, 900.0)]
    assert stated("a decision with slopes") == max(costs)
    names = ("RETARDER_TABLE", "RETARDER_LOAD")
    more = [size(sloped.types["RETARDER_TABLE"]) - size(program.types["RETARDER_TABLE"])]
    first, second = (
        [size(Program(texts_of(book)[TABLE_FILE]).types[names[1]]) for book in (TableBook(of), sloped_book(of))]
        for of in (default_book.tables[:1], default_book.tables[:2])
    )
    more.append((second[1] - second[0]) - (first[1] - first[0]))
    assert stated("times of decision and slopes: more") == more
    timed = Program(texts_of(TableBook(tuple(map(at_any_time, default_book.tables))))[TABLE_FILE])
    assert size(timed.types[names[0]]) - size(program.types[names[0]]) == stated("times of decision alone: more")[0]


def sloped_book(tables: tuple[ControllerTable, ...]) -> TableBook:
    """The tables with slopes."""
    return TableBook(tuple(with_slopes(table, -0.003, -0.003) for table in tables))


def at_any_time(table: ControllerTable) -> ControllerTable:
    """The table without slopes that decides at any time."""
    return replace(table, decisions=Decisions.AT_ANY_TIME)


@pytest.fixture(scope="module")
def estimating(default_book: TableBook) -> TableBook:
    """The default book with an estimator of 16 breaks for each class."""
    made = estimator_of(16, 37.45)
    return TableBook(
        tuple(
            replace(table, estimator=replace(made, friction_cv=0.15 if table.cut.mass_t < 30.0 else 0.16))
            for table in default_book.tables
        )
    )


def test_operations_of_an_estimate(estimating: TableBook) -> None:
    program = Program(texts_of(estimating)[TABLE_FILE])
    table, estimate, observer = (program.new(f"RETARDER_{name}") for name in ("TABLE", "ESTIMATE", "OBSERVE"))
    executed(program, "RETARDER_LOAD", TableNo=0, Table=table)
    worst = (0, 0)
    for track in golden_tracks(estimating)[:7]:
        program.call("RETARDER_BEGIN", program.new("RETARDER_BEGIN"), Estimate=estimate)
        for s, v, kpa, *_ in zip(*track.samples, strict=True):
            program.done.clear()
            program.call("RETARDER_OBSERVE", observer, Path_m=s, Speed_m_s=v, Overpressure_kpa=kpa, Table=table,
                         Estimate=estimate)  # fmt: skip
            worst = max(worst, counted(program.done))
    assert stated("`RETARDER_OBSERVE`, 16 breaks") == list(worst)
    twice = executed(program, "RETARDER_LOAD", TableNo=0, Table=table)
    assert stated("`RETARDER_LOAD`, table with an estimator") == list(twice)


def test_bytes_of_an_estimator(estimating: TableBook, default_book: TableBook) -> None:
    program, plain = (Program(texts_of(book)[TABLE_FILE]) for book in (estimating, default_book))
    assert stated("one `RETARDER_ESTIMATE`") == [size(program.types["RETARDER_ESTIMATE"])]
    assert stated("one `RETARDER_TABLE` with estimator") == [size(program.types["RETARDER_TABLE"])]
    three = Program(texts_of(TableBook(estimating.tables[:3]))[TABLE_FILE])
    few = Program(texts_of(TableBook(estimating.tables[:4]))[TABLE_FILE])
    growth = size(few.types["RETARDER_LOAD"]) - size(three.types["RETARDER_LOAD"])
    lines = Program(texts_of(TableBook(default_book.tables[:4]))[TABLE_FILE])
    fewer = Program(texts_of(TableBook(default_book.tables[:3]))[TABLE_FILE])
    # The fourth table brings its own constants, its touch pressure and number, and the second estimator.
    alone = growth - (size(lines.types["RETARDER_LOAD"]) - size(fewer.types["RETARDER_LOAD"])) - 6
    assert stated("constants of one estimator") == [alone]
    assert plain.blocks["RETARDER_DECIDE"].inputs == program.blocks["RETARDER_DECIDE"].inputs


def test_operations_of_a_choice(program: Program, default_book: TableBook) -> None:
    def choice(book: TableBook, speed: float) -> tuple[int, int]:
        each = Program(texts_of(book)[TABLE_FILE])
        table = each.new("RETARDER_TABLE")
        return executed(each, "RETARDER_SELECT", Layout=2, Category=1, Axles=4, Commanded_m_s=speed, Table=table)

    tables = default_book.tables
    others = [
        replace(table, id=f"other {table.id}", cut=replace(table.cut, category="X", category_number=16))
        for table in tables
    ]
    twice = TableBook((*tables, *others))
    between, more = choice(default_book, 2.5), choice(twice, 2.5)
    assert stated("`RETARDER_SELECT`, between") == list(between)
    assert stated("`RETARDER_SELECT`, tuned") == list(choice(default_book, 3.0))
    assert stated("`RETARDER_SELECT`, each further") == [(more[0] - between[0]) // len(others), 0]
    assert (more[0] - between[0]) % len(others) == 0
    table = program.new("RETARDER_TABLE")
    assert stated("`RETARDER_LOAD`, table without") == list(executed(program, "RETARDER_LOAD", TableNo=0, Table=table))


def test_operations_of_the_self_test(default_book: TableBook) -> None:
    for label, self_test in (("`RETARDER_SELF_TEST`, 6", FULL), ("`RETARDER_SELF_TEST`, small", SMALL)):
        program = Program(b"".join(texts_of(default_book, self_test).values()))
        instance, worst = program.new("RETARDER_SELF_TEST"), (0, 0)
        while not instance["DONE"].value:
            program.done.clear()
            program.call("RETARDER_SELF_TEST", instance, Restart=False)
            worst = max(worst, counted(program.done))
        assert stated(label) == list(worst)


def test_bytes(default_book: TableBook) -> None:
    files = texts_of(default_book)
    program = Program(files[TABLE_FILE])
    few = Program(texts_of(TableBook(default_book.tables[:5]))[TABLE_FILE])
    constants = sum(
        size(program.types[name]) - size(few.types[name]) for name in ("RETARDER_LOAD", "RETARDER_SELECT")
    ) - (size(program.types["RETARDER_LOAD"]) - size(few.types["RETARDER_LOAD"]))  # SELECT holds an instance of LOAD
    assert stated("one `RETARDER_TABLE` without") == [size(program.types["RETARDER_TABLE"])]
    assert stated("constants of one table") == [constants]
    one = default_book.tables[1]  # whose lines keep their order before the entrance, too
    alone, approached = (
        Program(texts_of(TableBook((table,)))[TABLE_FILE]).types for table in (one, with_approach(one, 4.0, 2))
    )
    more = [size(approached[name]) - size(alone[name]) for name in ("RETARDER_TABLE", "RETARDER_LOAD")]
    assert stated("an approach: more") == more
    for label, self_test in (("self-test of one table", FULL), ("the same, small", SMALL)):
        program = Program(b"".join(texts_of(default_book, self_test).values()))
        tests = [size(program.types[f"RETARDER_TEST_{number}"]) for number in range(len(default_book.tables))]
        assert stated(label) == [min(tests), max(tests), size(program.types["RETARDER_SELF_TEST"])]
