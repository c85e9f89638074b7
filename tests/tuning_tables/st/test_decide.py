"""RETARDER_DECIDE, run from its parse tree, decides as the Python rule does."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

from scripts.studies.in_the_loop.agreement import ask
from tests.tuning_tables.st.compiler import ROUNDINGS, Compiler, name_of
from tests.tuning_tables.st.conftest import program_of, texts_of
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.storage import Fault, Frame
from tuning_tables import decide_many
from tuning_tables.golden_vectors import golden_vectors
from tuning_tables.st_source import TABLE_FILE
from tuning_tables.table_book import TableBook

READINGS = 1_000_000


@pytest.fixture(scope="module", params=ROUNDINGS, ids=name_of)
def compiler(request: pytest.FixtureRequest) -> Compiler:
    """How the controller calculates with REAL between two assignments."""
    each: Compiler = request.param
    return each


def loaded(program: Program, number: int) -> Frame:
    """Table `number` as RETARDER_LOAD gives it."""
    loader, table = program.new("RETARDER_LOAD"), program.new("RETARDER_TABLE")
    program.call("RETARDER_LOAD", loader, TableNo=number, Table=table)
    assert loader["FOUND"].value
    return table


def answers(
    program: Program,
    table: Frame,
    stage: npt.ArrayLike,
    s_m: npt.ArrayLike,
    v_m_s: npt.ArrayLike,
    pressure_kpa: npt.ArrayLike = np.nan,
) -> npt.NDArray[np.int64]:
    """What RETARDER_DECIDE answers with `table`; the pressure is handed over where there is such an input."""
    decider = program.new("RETARDER_DECIDE")
    more = {"Pressure_kpa": pressure_kpa} if "PRESSURE_KPA" in decider else {}
    program.call("RETARDER_DECIDE", decider, Stage=stage, Path_m=s_m, Speed_m_s=v_m_s, Table=table, **more)
    wanted: npt.NDArray[np.int64] = decider["WANTED"].value
    return wanted


def decisions(book: TableBook, readings: npt.NDArray[np.void], compiler: Compiler) -> npt.NDArray[np.int64]:
    """What the Structured Text of the book answers to readings, dtype READING."""
    program = Program(texts_of(book)[TABLE_FILE], compiler)
    found = np.full(len(readings), -(2**31))
    for number in np.unique(readings["table"]).tolist():
        here = readings["table"] == number
        # An INT has 16 bits, so that a wider stage cannot reach the block.
        stage = readings["stage"][here]
        narrow = np.clip(stage, -32768, 32767)
        asked = (readings[name][here] for name in ("s_m", "v_m_s", "pressure_kpa"))
        wanted = answers(program, loaded(program, number), narrow, *asked)
        found[here] = np.where(wanted == narrow, stage, wanted)
    return found


def test_a_million_hard_readings_are_decided_alike(book: TableBook, compiler: Compiler) -> None:
    questions = ask(book, READINGS, 10, 20261121)
    found = decisions(book, questions.readings, compiler)
    assert np.count_nonzero(found != questions.decisions) == 0
    far = found - questions.readings["stage"]
    assert min(np.count_nonzero(far < 0), np.count_nonzero(far == 0), np.count_nonzero(far > 0)) > 50_000
    assert np.count_nonzero(abs(far) > 1) > 20_000


def test_the_default_book_is_decided_alike(default_book: TableBook, compiler: Compiler) -> None:
    questions = ask(default_book, 200_000, 10, 5)
    assert np.count_nonzero(decisions(default_book, questions.readings, compiler) != questions.decisions) == 0


def test_every_golden_vector_is_answered(default_book: TableBook) -> None:
    program = program_of(default_book)
    for number, source in enumerate(default_book.tables):
        vectors = golden_vectors(source)
        found = answers(program, loaded(program, number), vectors.stage, vectors.s_m, vectors.v_m_s)
        assert np.array_equal(found, vectors.answer)


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("Speed_m_s < Line", "Speed_m_s <= Line"),
        ("Speed_m_s > Line", "Speed_m_s >= Line"),
        ("Speed_m_s >= 0.0", "Speed_m_s > 0.0"),
        ("Path_m <= 3.4028235E+38", "Path_m <= 3.0E+38"),
        ("Path := Table.PathMax_m", "Path := Path_m"),
        ("Table.Powers - 2 TO 0", "Table.Powers - 2 TO 1"),
        ("Wanted * 8 + 4", "Wanted * 8"),
        ("Answer := -1;", "Answer := 1;"),
        ("Farthest := Table.Stages - 1;", "Farthest := 1;"),
        ("Farthest := Table.Stages - 1;", "Farthest := Table.Stages - 2;"),
        ("Before := Answer;", "Before := 0;"),
    ],
)
def test_a_wrong_rule_is_found(default_book: TableBook, right: str, wrong: str) -> None:
    questions = ask(default_book, 60_000, 10, 6)
    text = texts_of(default_book)[TABLE_FILE].decode("ascii")
    assert right in text
    program = Program(text.replace(right, wrong).encode("ascii"))
    asked = questions.readings[(questions.readings["table"] == 3) & (np.abs(questions.readings["stage"]) < 32768)]
    expected = decide_many(default_book.tables[3], asked["stage"], asked["s_m"], asked["v_m_s"])
    inputs = (asked["stage"], asked["s_m"], asked["v_m_s"])
    if wrong == "Path := Path_m":
        # Without the clamp the line leaves the float32 numbers before an answer can be wrong.
        with pytest.raises(Fault, match="no REAL result"):
            answers(program, loaded(program, 3), *inputs)
    else:
        assert np.count_nonzero(answers(program, loaded(program, 3), *inputs) != expected) > 0


@pytest.mark.parametrize("stages", [-32768, -1, 0, 6, 32767])
@pytest.mark.parametrize("powers", [-32768, 0, 5, 32767])
def test_a_table_that_was_never_loaded_or_is_spoilt_holds(default_book: TableBook, stages: int, powers: int) -> None:
    program = program_of(default_book)
    table = program.new("RETARDER_TABLE")
    for key, value in (("STAGES", stages), ("POWERS", powers)):
        table[key].store(value, None)
    for row in ("HASLOWER", "HASUPPER"):
        table[row].data[:] = True
    stage = np.array([-32768, -1, 0, 4, 5, 6, 32766, 32767])
    assert np.array_equal(answers(program, table, stage, 10.0, 100.0), stage)


def test_no_such_table_leaves_none_behind(default_book: TableBook) -> None:
    program = program_of(default_book)
    for number in (-32768, -1, 6, 32767):
        loader, table = program.new("RETARDER_LOAD"), loaded(program, 0)
        assert table["STAGES"].value == 5
        program.call("RETARDER_LOAD", loader, TableNo=number, Table=table)
        assert not loader["FOUND"].value
        assert table["STAGES"].value == 0
