"""Tables that decide at any time, in Structured Text: surfaces, the choice, and wrong text that is found."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tuning_tables.table_block import block_size

from scripts.studies.in_the_loop.agreement import ask
from tests.controller_code.sample_book import approaching_book, sample_book, surface_book, with_slopes
from tests.controller_code.test_surface_code import mutants, pairs
from tests.tuning_tables.st.compiler import ROUNDINGS, Compiler, name_of
from tests.tuning_tables.st.conftest import program_of, shaped_book, texts_of
from tests.tuning_tables.st.test_decide import answers, decisions, loaded
from tests.tuning_tables.st.test_select import require_equal, select
from tests.tuning_tables.st.test_self_test import another, calls_of, next_number, run_all, run_until_found
from tests.tuning_tables.st.test_syntax import require_structured_text
from tuning_tables import Decisions
from tuning_tables.golden_vectors import FEW, few_golden_vectors, golden_vectors
from tuning_tables.self_test_size import FULL, SMALL, SelfTestSize
from tuning_tables.st_source import SELF_TEST_FILE, TABLE_FILE
from tuning_tables.table_book import TableBook


@pytest.fixture(scope="module", params=[True, False], ids=["estimated and approached", "measured"])
def surfaces(request: pytest.FixtureRequest) -> TableBook:
    """Tables of many shapes that decide at any time, most with slopes."""
    return surface_book(approaching_book() if request.param else sample_book())


@pytest.fixture(scope="module")
def wanted() -> TableBook:
    """Tables that show every wrong text."""
    return mutants()


@pytest.fixture(scope="module")
def timed(default_book: TableBook) -> TableBook:
    """Without a gauge: one of six tables decides at any time."""
    first, *others = default_book.tables
    return TableBook((replace(first, decisions=Decisions.AT_ANY_TIME), *others))


def test_it_is_structured_text_and_its_self_test_finds_nothing_wrong(surfaces: TableBook, timed: TableBook) -> None:
    for table in surfaces.tables:
        assert len(few_golden_vectors(table)) <= FEW * np.count_nonzero(table.has_line)
    for book in (surfaces, timed):
        require_structured_text(book)
        for size in (FULL, SMALL):
            outputs = run_all(texts_of(book, size), calls_of(book))
            assert outputs == {"DONE": True, "FAILED": 0, "FIRSTFAILED": -1, "FIRSTFAULT": -1}


def test_the_largest_table_is_structured_text() -> None:
    require_structured_text(TableBook((with_slopes(shaped_book(32, 9).tables[0], -1e-5, -1e-5),)))


@pytest.mark.parametrize("compiler", ROUNDINGS, ids=name_of)
def test_hard_readings_are_decided_alike(surfaces: TableBook, compiler: Compiler) -> None:
    questions = ask(surfaces, 200_000, 10, 20261123)
    assert np.count_nonzero(decisions(surfaces, questions.readings, compiler) != questions.decisions) == 0
    silent = questions.readings.copy()
    silent["pressure_kpa"] = np.nan
    assert np.count_nonzero(decisions(surfaces, silent, compiler) != questions.decisions) > 20_000


def test_every_golden_vector_is_answered(surfaces: TableBook) -> None:
    program = program_of(surfaces)
    for number, source in enumerate(surfaces.tables):
        vectors = golden_vectors(source)
        asked = (vectors.stage, vectors.s_m, vectors.v_m_s, vectors.pressure_kpa)
        assert np.array_equal(answers(program, loaded(program, number), *asked), vectors.answer)


def test_the_choice_is_that_of_python(surfaces: TableBook) -> None:
    for book in (surfaces, pairs()):
        questions = ask(book, 60_000, 3_000, 20261123)
        statuses, table = select(book, questions.commands)
        require_equal(book, questions, statuses, table)
        size, chosen = block_size(book), statuses >= 0
        words = questions.chosen[chosen]
        numbers = words[:, size.pressures].view(np.float32)
        assert np.array_equal(table["ATANYTIME"][chosen], words[:, size.at_any_time.start] == 1)
        assert np.array_equal(table["HIGHESTPRESSURE_KPA"][chosen], numbers[:, 0])
        assert np.array_equal(table["PRESSURE_KPA"][chosen], numbers[:, 1 : 1 + size.stages])
        assert np.array_equal(table["SLOPE"][chosen], numbers[:, 1 + size.stages :])
        assert {0, 1, 2} < {*statuses.tolist()}


def test_a_loaded_table_tells_when_it_decides(timed: TableBook) -> None:
    text, program = texts_of(timed)[TABLE_FILE], program_of(timed)
    told = [bool(loaded(program, number)["ATANYTIME"].value) for number in range(len(timed.tables))]
    assert told == [True, False, False, False, False, False]
    assert "PRESSURE_KPA" not in program.new("RETARDER_DECIDE")
    assert b"gauge" not in text


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("Above < Table.Pressure_kpa[0]", "Above > Table.Pressure_kpa[0]"),
        ("Above < Table.Pressure_kpa[0]", "FALSE"),
        ("Above > Table.HighestPressure_kpa", "Above < Table.HighestPressure_kpa"),
        ("Above > Table.HighestPressure_kpa", "FALSE"),
        ("Above := Pressure_kpa;", "Above := 0.0;"),
        ("Above := Above - Table.Pressure_kpa[Stage];", "Above := Table.Pressure_kpa[Stage] - Above;"),
        ("Above := Above - Table.Pressure_kpa[Stage];", "Above := Above - Table.Pressure_kpa[0];"),
        ("Table.Slope[Wanted * 2] * Above", "Table.Slope[Wanted * 2 + 1] * Above"),
        ("Table.Slope[Wanted * 2 + 1] * Above", "Table.Slope[Wanted * 2] * Above"),
        ("Table.Slope[Wanted * 2 + 1] * Above;\n                Line := Line + Rise;",
         "Table.Slope[Wanted * 2 + 1] * Above;\n                Line := Line - Rise;"),
        ("IF Table.AtAnyTime THEN", "IF FALSE THEN"),
        ("IF Table.AtAnyTime THEN", "IF TRUE THEN"),
        ("Table.AtAnyTime := AtAnyTimeOf[TableNo];", "Table.AtAnyTime := TRUE;"),
        ("AND NOT (Table.AtAnyTime XOR Faster.AtAnyTime)", ""),
        ("Table.Pressure_kpa[Index] <> Faster.Pressure_kpa[Index]", "FALSE"),
        ("Table.Pressure_kpa[Index] <> Faster.Pressure_kpa[Index]",
         "Table.Pressure_kpa[Index] < Faster.Pressure_kpa[Index]"),
        ("Table.Pressure_kpa[Index] <> Faster.Pressure_kpa[Index]",
         "Table.Pressure_kpa[Index] > Faster.Pressure_kpa[Index]"),
        ("Low := Table.Slope[Index];", "Low := Faster.Slope[Index];"),
        ("Table.Slope[Index] := Low + Rise;", "Table.Slope[Index] := Low;"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("size", [FULL, SMALL], ids=["full", "small"])
def test_wrong_surfaces_are_found_by_the_self_test(
    wanted: TableBook, right: str, wrong: str, size: SelfTestSize
) -> None:
    def change(tables: str, test: str) -> tuple[str, str]:
        assert tables.count(right) == 1
        return tables.replace(right, wrong), test

    assert run_until_found(texts_of(wanted, size), calls_of(wanted), change)["FAILED"] > 0


@pytest.mark.parametrize(
    ("array", "place", "table"),
    [("HighestPressureOf", 1, 1), ("Pressure_0", 2, 0), ("Slope_2", 3, 2), ("AtAnyTimeOf", 0, 0)],
)
@pytest.mark.parametrize("size", [FULL, SMALL], ids=["full", "small"])
def test_one_changed_constant_is_found(
    wanted: TableBook, array: str, place: int, table: int, size: SelfTestSize
) -> None:
    def change(tables: str, test: str) -> tuple[str, str]:
        begin, end = next_number(tables, f"    {array} ", place)
        return tables[:begin] + another(tables[begin:end]) + tables[end:], test

    assert run_until_found(texts_of(wanted, size), calls_of(wanted), change)["FIRSTFAILED"] == table


def test_only_such_books_speak_of_it(wanted: TableBook, default_book: TableBook) -> None:
    assert "at every sample if AtAnyTime of the table is TRUE" in texts_of(wanted)[TABLE_FILE].decode("ascii")
    for name in (TABLE_FILE, SELF_TEST_FILE):
        text = texts_of(default_book)[name].decode("ascii")
        assert not any(word in text for word in ("AtAnyTime", "at any time", "Pressure_kpa", "gauge"))
