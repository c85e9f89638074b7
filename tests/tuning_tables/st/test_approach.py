"""Tables that act before the entrance, in Structured Text: the gate, the choice, and wrong text that is found."""

from __future__ import annotations

import numpy as np
import pytest

from scripts.studies.in_the_loop.agreement import ask
from tests.controller_code.sample_book import approaching_book
from tests.tuning_tables.st.compiler import ROUNDINGS, Compiler, name_of
from tests.tuning_tables.st.conftest import program_of, texts_of
from tests.tuning_tables.st.test_decide import decisions, loaded
from tests.tuning_tables.st.test_select import require_equal, select
from tests.tuning_tables.st.test_self_test import another, calls_of, next_number, run_all, run_until_found
from tests.tuning_tables.st.test_syntax import require_structured_text
from tuning_tables.golden_vectors import FEW, few_golden_vectors
from tuning_tables.self_test_size import FULL, SMALL, SelfTestSize
from tuning_tables.st_source import SELF_TEST_FILE, TABLE_FILE
from tuning_tables.table_book import TableBook


@pytest.fixture(scope="module", params=[True, False], ids=["estimated", "measured"])
def approached(request: pytest.FixtureRequest) -> TableBook:
    """Tables of many shapes with approaches, with and without estimators."""
    return approaching_book(request.param)


@pytest.fixture(scope="module")
def few() -> TableBook:
    """The class with three targets, of which two have equal approaches."""
    return TableBook(approaching_book(False).tables[:3])


def test_it_is_structured_text_and_its_self_test_finds_nothing_wrong(approached: TableBook) -> None:
    require_structured_text(approached)
    for table in approached.tables:
        assert len(few_golden_vectors(table)) <= FEW * np.count_nonzero(table.has_line)
    for size in (FULL, SMALL):
        outputs = run_all(texts_of(approached, size), calls_of(approached))
        assert outputs == {"DONE": True, "FAILED": 0, "FIRSTFAILED": -1, "FIRSTFAULT": -1}


@pytest.mark.parametrize("compiler", ROUNDINGS, ids=name_of)
def test_hard_readings_are_decided_alike(approached: TableBook, compiler: Compiler) -> None:
    questions = ask(approached, 200_000, 10, 20261122)
    before = (questions.readings["s_m"] < 0.0) & (questions.readings["s_m"] > -10.0)
    far = (questions.decisions - questions.readings["stage"])[before]
    assert min(np.count_nonzero(far < 0), np.count_nonzero(far == 0), np.count_nonzero(far > 0)) > 2_000
    assert np.count_nonzero(far > 1) > 200
    assert np.count_nonzero(decisions(approached, questions.readings, compiler) != questions.decisions) == 0


def test_the_choice_is_that_of_python(approached: TableBook) -> None:
    questions = ask(approached, 60_000, 3_000, 20261122)
    require_equal(approached, questions, *select(approached, questions.commands))


def test_a_loaded_table_tells_its_approach(approached: TableBook) -> None:
    program = program_of(approached)
    for number, source in enumerate(approached.tables):
        table = loaded(program, number)
        assert table["ENTRANCESTAGE"].value == source.entrance_stage
        length_m = 0.0 if source.approach is None else source.approach.length_m
        assert table["APPROACH_M"].value == np.float32(length_m)


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("(Path >= 0.0) OR", "(Path > 0.0) OR"),
        ("(Path >= 0.0) OR", "(Path <= 0.0) OR"),
        ("(Path >= 0.0) OR (Wanted < Table.EntranceStage)", "TRUE"),
        ("(Wanted < Table.EntranceStage)", "(Wanted <= Table.EntranceStage)"),
        ("(Wanted < Table.EntranceStage)", "FALSE"),
        ("Table.EntranceStage := EntranceStageOf[TableNo];", "Table.EntranceStage := 1;"),
        ("Table.Approach_m := ApproachOf[TableNo];", "Table.Approach_m := 0.0;"),
        ("AND (Table.EntranceStage = Faster.EntranceStage)", ""),
    ],
)
@pytest.mark.parametrize("size", [FULL, SMALL], ids=["full", "small"])
def test_a_wrong_gate_is_found_by_the_self_test(few: TableBook, right: str, wrong: str, size: SelfTestSize) -> None:
    def change(tables: str, test: str) -> tuple[str, str]:
        assert right in tables
        return tables.replace(right, wrong), test

    assert run_until_found(texts_of(few, size), calls_of(few), change)["FAILED"] > 0


@pytest.mark.parametrize(("array", "place"), [("ApproachOf", 1), ("EntranceStageOf", 0), ("EntranceStageOf", 2)])
def test_one_changed_constant_is_found(few: TableBook, array: str, place: int) -> None:
    def change(tables: str, test: str) -> tuple[str, str]:
        begin, end = next_number(tables, f"    {array} ", place)
        return tables[:begin] + another(tables[begin:end]) + tables[end:], test

    outputs = run_until_found(texts_of(few), calls_of(few), change)
    assert outputs["FIRSTFAILED"] == place


def test_the_interlock_is_stated_where_there_is_an_approach(few: TableBook, default_book: TableBook) -> None:
    text = texts_of(few)[TABLE_FILE].decode("ascii")
    assert "only when the cut ahead has left the" in text
    for name in (TABLE_FILE, SELF_TEST_FILE):
        assert "pproach" not in texts_of(default_book)[name].decode("ascii")
