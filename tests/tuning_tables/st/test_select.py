"""RETARDER_SELECT, run from its parse tree, chooses as `TableBook.choose` does, to the last bit."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import pytest
from tuning_tables.table_block import HAS_LOWER, HAS_UPPER, block_size

from scripts.studies.in_the_loop.agreement import Questions, ask
from tests.tuning_tables.st.compiler import BINARY32, ROUNDINGS, Compiler, name_of
from tests.tuning_tables.st.conftest import program_of, texts_of
from tests.tuning_tables.st.evaluator import Program
from tuning_tables import ControllerTable, Stage, decide_many
from tuning_tables.st_source import TABLE_FILE
from tuning_tables.table_book import Status, TableBook

Chosen: TypeAlias = dict[str, npt.NDArray[Any]]
"""Arrays with a row a command, by the name of the variable."""

COMMANDS = 8_000


def select(
    book: TableBook,
    commands: npt.NDArray[np.void],
    compiler: Compiler = BINARY32,
    text: bytes | None = None,
    prefix: str = "RETARDER",
) -> tuple[npt.NDArray[np.int64], Chosen]:
    """Statuses of the commands, and the tables chosen, as a dictionary of arrays with a row a command."""
    program = Program(text or texts_of(book)[TABLE_FILE], compiler)
    selector, table = program.new(f"{prefix}_SELECT"), program.new(f"{prefix}_TABLE")
    program.call(
        f"{prefix}_SELECT",
        selector,
        Layout=np.minimum(commands["layout"], 32767).astype(np.int64),
        Category=commands["category"].astype(np.int64),
        Axles=commands["axles"].astype(np.int64),
        Commanded_m_s=commands["speed_m_s"],
        Table=table,
    )
    found = {name: getattr(cell, "value", None) for name, cell in table.items()}
    return selector["STATUS"].value, {
        **found,
        **{name: row.data for name, row in table.items() if hasattr(row, "data")},
    }


def require_equal(book: TableBook, questions: Questions, statuses: npt.NDArray[np.int64], table: Chosen) -> None:
    """Statuses as in `questions`, and where a table was chosen every number of it; bits, except the sign of 0."""
    assert np.count_nonzero(statuses != questions.statuses) == 0
    size, chosen = block_size(book), statuses >= 0
    words = questions.chosen[chosen]
    lines, numbers = words[:, 4 : 4 + size.stages], words[:, 4 + size.stages : size.coefficients.stop].view(np.float32)
    assert np.array_equal(table["STAGES"][chosen], words[:, 2])
    assert np.array_equal(table["POWERS"][chosen], words[:, 3])
    assert np.array_equal(table["HASLOWER"][chosen], (lines & HAS_LOWER) > 0)
    assert np.array_equal(table["HASUPPER"][chosen], (lines & HAS_UPPER) > 0)
    for column, name in ((1, "TARGET_M_S"), (2, "PATHMIN_M"), (3, "PATHMAX_M")):
        assert np.array_equal(table[name][chosen], numbers[:, column])
    assert np.array_equal(table["COEFFICIENT"][chosen], numbers[:, 4:])
    assert not table["STAGES"][~chosen].any()


@pytest.mark.parametrize("compiler", ROUNDINGS, ids=name_of)
def test_the_choice_is_that_of_python(book: TableBook, default_book: TableBook, compiler: Compiler) -> None:
    for each in (book, default_book):
        questions = ask(each, 60_000, COMMANDS, 20261122)
        require_equal(each, questions, *select(each, questions.commands, compiler))


def test_every_status_occurs(book: TableBook) -> None:
    questions = ask(book, 60_000, COMMANDS, 20261122)
    assert {int(status) for status in Status} == set(questions.statuses.tolist())
    assert np.count_nonzero(questions.statuses == Status.BETWEEN) > 100


def test_the_chosen_lines_between_two_tables_decide_as_python(default_book: TableBook) -> None:
    program = program_of(default_book)
    speeds = np.array([2.25, 2.5, 3.1, 3.75], np.float32)
    rng = np.random.default_rng(3)
    for speed in speeds:
        selector, table, decider = (
            program.new(name) for name in ("RETARDER_SELECT", "RETARDER_TABLE", "RETARDER_DECIDE")
        )
        program.call("RETARDER_SELECT", selector, Layout=2, Category=3, Axles=4, Commanded_m_s=speed, Table=table)
        chosen = default_book.choose("С", 4, float(speed)).table
        assert chosen is not None
        stage, s = rng.integers(0, 5, 20_000), rng.uniform(-1.0, 39.0, 20_000).astype(np.float32)
        v = rng.uniform(0.0, 9.0, 20_000).astype(np.float32)
        program.call("RETARDER_DECIDE", decider, Stage=stage, Path_m=s, Speed_m_s=v, Table=table)
        assert np.array_equal(decider["WANTED"].value, decide_many(chosen, stage, s, v))


@pytest.mark.parametrize("order", [(1, 0), (0, 1)])
def test_the_order_of_the_book_does_not_count_for_different_targets(
    small_book: TableBook, order: tuple[int, int]
) -> None:
    turned = TableBook(tuple(small_book.tables[index] for index in order))
    questions = ask(turned, 20_000, 500, 4)
    require_equal(turned, questions, *select(turned, questions.commands))


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("MassOf[Number] > Heaviest_t", "MassOf[Number] >= Heaviest_t"),
        ("MassOf[Number] >= Heaviest_t", "MassOf[Number] > 0.0"),
        ("Target > SlowerTarget", "Target >= SlowerTarget"),
        ("Target < FasterTarget", "Target > FasterTarget"),
        ("Target <= Commanded_m_s", "Target < Commanded_m_s"),
        ("Commanded_m_s <= 3.4028235E+38", "TRUE"),
        ("Fits := FALSE;", "Fits := TRUE;"),
        ("(Table.Powers = Faster.Powers)", "TRUE"),
        ("Weight / Span", "Span / Weight"),
        ("Rise := Weight * Rise;", "Rise := Weight + Rise;"),
        ("Table.Target_m_s := Commanded_m_s;", "Table.Target_m_s := FasterTarget;"),
        ("Status := -2;", "Status := -1;"),
    ],
)
def test_a_wrong_choice_is_found(hard_questions: Questions, right: str, wrong: str) -> None:
    book = hard_questions.book
    text = texts_of(book)[TABLE_FILE].decode("ascii")
    assert right in text
    statuses, table = select(book, hard_questions.commands, text=text.replace(right, wrong).encode("ascii"))
    with pytest.raises(AssertionError):
        require_equal(book, hard_questions, statuses, table)


def test_the_right_choice_passes_where_wrong_ones_are_found(hard_questions: Questions) -> None:
    require_equal(hard_questions.book, hard_questions, *select(hard_questions.book, hard_questions.commands))


@pytest.fixture(scope="module")
def hard_questions(book: TableBook) -> Questions:
    """Besides the usual tables one of equal target and other lines, and a neighbour of equal size and other lines."""
    stages = _without_last_upper(book.tables[2])
    twin = replace(book.tables[2], id="twin", stages=stages)
    neighbour = replace(book.tables[2], id="neighbour", target_speed_m_s=5.0, stages=stages)
    return ask(TableBook((*book.tables, twin, neighbour)), 60_000, 3_000, 7)


def _without_last_upper(table: ControllerTable) -> tuple[Stage, ...]:
    last = max(stage.k for stage in table.stages if stage.upper is not None)
    return tuple(replace(stage, upper=None) if stage.k == last else stage for stage in table.stages)
