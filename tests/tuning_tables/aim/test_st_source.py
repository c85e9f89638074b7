"""The Structured Text of aim tables, run from its parse tree: bit for bit the Python rule; what its self-test finds."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

import numpy as np
import pytest

from tests.effort import QUESTIONS, every
from tests.st_files import aim_st_files
from tests.tuning_tables.aim.made_tables import (
    answers,
    category_table,
    hard_questions,
    measured_table,
    reported_of,
    sample_set,
)
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.storage import Fault, Frame
from tests.tuning_tables.st.syntax import ASKED_UNDER, BINARY32, ROUNDINGS, Compiler, faults, name_of, parse
from tuning_tables.aim import AimAxes, AimCategory, AimTable, AimTables
from tuning_tables.aim.golden_aims import golden_selections
from tuning_tables.export_names import RETARDER
from tuning_tables.self_test_size import FULL, SMALL, SelfTestSize

AIM_FILE, SELF_TEST_FILE = "aim_table.st", "aim_self_test.st"
SOUND = {"DONE": 1, "FAILED": 0, "FIRSTFAILED": -1, "FIRSTFAULT": -1}


def loaded(program: Program, number: int) -> Frame:
    """The table of a number, as the export loads it."""
    table, load = program.new("AIM_TABLE"), program.new("AIM_LOAD")
    program.call("AIM_LOAD", load, TableNo=number, Table=table)
    return table


@pytest.mark.requirement("CODE-02")
@pytest.mark.parametrize("compiler", ASKED_UNDER, ids=name_of)
def test_hard_questions_are_answered_as_by_python_to_the_last_bit(compiler: Compiler) -> None:
    aims = sample_set()
    asked = hard_questions(aims, QUESTIONS, 20261123)
    asked["cars"] = np.clip(asked["cars"], -32768, 32767)  # an INT has 16 bits
    program = Program(aim_st_files(aims)[AIM_FILE], compiler)
    right = answers(aims, asked)
    for number in range(len(aims.tables)):
        here = asked[asked["table"] == number]
        block = program.new("AIM_EXIT_SPEED")
        program.call(
            "AIM_EXIT_SPEED", block, Table=loaded(program, number), Cars=here["cars"].astype(np.int64),
            FreeDistance_m=here["distance"], Resistance_n_per_kn=here["resistance"],
        )  # fmt: skip
        found = block["EXITSPEED_M_S"].value
        assert np.array_equal(found.view(np.uint32), right[asked["table"] == number].view(np.uint32))


@pytest.mark.parametrize("number", [-32768, -1, 3, 32767])
def test_no_such_table_gives_no_answer(number: int) -> None:
    program = Program(aim_st_files(small_set())[AIM_FILE])
    block = program.new("AIM_EXIT_SPEED")
    for table, answered in ((0, True), (number, False)):
        given = loaded(program, table)
        program.call("AIM_EXIT_SPEED", block, Table=given, Cars=3, FreeDistance_m=60.0, Resistance_n_per_kn=2.0)
        assert (block["EXITSPEED_M_S"].value > 0.0) is np.bool_(answered)


def test_every_selection() -> None:
    aims = sample_set()
    program = Program(aim_st_files(aims)[AIM_FILE])
    block = program.new("AIM_SELECT")
    for category, measured, number in golden_selections(aims):
        program.call("AIM_SELECT", block, Category=category, Measured=np.bool_(measured))
        assert block["TABLENO"].value == number


def small_table(measured: bool) -> AimTable:
    """Two numbers of cars, three distances, two resistances, and one null."""
    speeds = np.array([[[0.9, 1.1], [1.0, 1.4], [np.nan, 1.7]], [[0.95, 1.2], [1.1, 1.5], [1.3, 1.9]]])
    axes = AimAxes(np.array([1, 3]), np.array([10.0, 25.0, 60.0]), np.array([0.3, 1.7]) if measured else None)
    speeds = speeds if measured else speeds[:, :, 0]
    source = measured_table() if measured else category_table()
    return replace(source, axes=axes, exit_speed_m_s=speeds, reported=reported_of(speeds))


def small_set() -> AimTables:
    return AimTables((small_table(False), small_table(True), category_table(1.5, 4, "СТ")))


def run_all(
    files: Mapping[str, bytes], calls: int, change: Callable[[str], str] = str, compiler: Compiler = BINARY32
) -> dict[str, int]:
    """The outputs after that many calls of AIM_SELF_TEST, with the text of the tables changed."""
    texts = change(files[AIM_FILE].decode("ascii")), files[SELF_TEST_FILE].decode("ascii")
    program = Program("".join(texts).encode("ascii"), compiler)
    instance = program.new("AIM_SELF_TEST")
    for _ in range(calls):
        program.call("AIM_SELF_TEST", instance, Restart=False)
    return {name: int(instance[name].value) for name in SOUND}


@pytest.mark.parametrize("compiler", every(2, ROUNDINGS), ids=name_of)
def test_nothing_is_wrong_with_the_export(compiler: Compiler) -> None:
    for aims in (small_set(), AimTables(sample_set().tables[:8])):
        for size in (FULL, SMALL):
            assert run_all(aim_st_files(aims, RETARDER, size), 2 * len(aims.tables) + 2, compiler=compiler) == SOUND


def test_it_takes_two_calls_a_table_and_two_and_can_be_repeated() -> None:
    program = Program(b"".join(aim_st_files(small_set()).values()))
    instance = program.new("AIM_SELF_TEST")
    seen = []
    for restart in [*[False] * 9, True, *[False] * 7]:
        program.call("AIM_SELF_TEST", instance, Restart=restart)
        seen.append(bool(instance["DONE"].value))
    assert seen == [*[False] * 7, True, True, *[False] * 7, True]


def constants_in(text: str) -> Iterator[tuple[int, int]]:
    """Spans of all numbers in constant arrays."""
    number = re.compile(r"-?\d+\.\d+(?:E[+-]\d+)?|-?\d+|TRUE|FALSE")
    for array in re.finditer(r"^    \w+ : ARRAY\[.*?:= \[(.*?)\];", text, re.MULTILINE | re.DOTALL):
        yield from (found.span() for found in number.finditer(text, *array.span(1)))


def another(literal: str) -> str:
    """A literal of the same kind, and another value; a REAL by one float32 step."""
    if literal in ("TRUE", "FALSE"):
        return "FALSE" if literal == "TRUE" else "TRUE"
    if "." not in literal:
        return str(int(literal) + 1)
    if float(literal) < 0.0:
        return literal[1:]  # any speed below 0 stands for none
    return f"{np.nextafter(np.float32(literal), np.float32(np.inf)):.9E}" if float(literal) else "1.0E-01"


@pytest.mark.parametrize("size", every(2, [SMALL, FULL]), ids=["small", "full"])
def test_every_changed_constant_is_found(size: SelfTestSize) -> None:
    aims = AimTables((small_table(False), small_table(True)))
    files = aim_st_files(aims, RETARDER, size)
    spans = list(constants_in(files[AIM_FILE].decode("ascii")))
    # Numbers of both tables, the part of each, axes and speeds with room for both, and what the choice has of them.
    assert len(spans) == 2 * (9 + 1 + (2 + 3 + 2 + 12) + 2)
    for begin, end in spans:

        def change(text: str, begin: int = begin, end: int = end) -> str:
            return text[:begin] + another(text[begin:end]) + text[end:]

        with contextlib.suppress(Fault):  # an index out of its array: a controller stops
            assert run_all(files, 5, change)["FAILED"] > 0, files[AIM_FILE][begin - 60 : end]


SAME = {
    "AND (LeastNumber < FreeDistance_m) AND (FreeDistance_m <= LargestNumber);",
    "Answered := (1 < Table.Listed) AND (Table.Listed <= 5) AND (1 <= Table.Distances) AND (Table.Distances <= 7)",
    "Answered := (1 <= Table.Listed) AND (Table.Listed <= 5) AND (1 < Table.Distances) AND (Table.Distances <= 7)",
    "Answered := Answered AND (1 < Table.Resistances) AND (Table.Resistances <= 2)",
    "IF (0.0 < Near) AND (Near <= Far) THEN",
    "IF (Near > 0.0) AND (Far >= 0.0) THEN",
    "IF (Near >= 0.0) AND (Far > 0.0) THEN",
    "IF (Lower < (Table.Resistances - 1)) AND (Resistance >= Table.Resistance_n_per_kn[Lower]) THEN",
    "IF (Row = First) OR (Found <= Least) THEN",
    "IF Distance > Table.Distance_m[Node] THEN",
    "IF Resistance > Table.Resistance_n_per_kn[Node] THEN",
    "IF Near <= Far THEN",
    "IF Near > Far THEN",
    "IF Speed <= Far THEN",
    "IF Speed >= Far THEN",
}
"""Changed comparisons that change no answer: no axis here has one node, no speed is 0, no distance is below the least
number, and what happens to equal numbers is the same; at a node the part of the way is 0 or 1."""


def test_the_largest_table_is_exported() -> None:
    axes = AimAxes(np.arange(1, 21), np.arange(1.0, 112.0), np.arange(9.0))
    speeds = np.broadcast_to(np.linspace(0.5, 7.0, 111)[:, None], axes.shape).copy()
    table = replace(measured_table(), axes=axes, exit_speed_m_s=speeds, reported=reported_of(speeds))
    program = Program(b"".join(aim_st_files(AimTables((table,)), RETARDER, SMALL).values()))
    assert "AIM_SELF_TEST" in program.blocks
    assert table.held.speed_m_s.size < 32767  # what an INT counts
    load = aim_st_files(AimTables((table,)), RETARDER, SMALL)[AIM_FILE].decode("ascii")
    assert max(int(each) for each in re.findall(r"ARRAY\[0\.\.(\d+)\] OF \w+ :=", load)) < 999


def test_as_many_tables_as_there_are_categories_are_exported() -> None:
    made = [
        replace(small_table(measured), id=f"{n} {measured}", category=AimCategory(16 + n, f"own {n}"))
        for n in range(240)
        for measured in (False, True)
    ]
    text = aim_st_files(AimTables(tuple(made)))[AIM_FILE]
    assert faults(parse(text)) == []
    assert b"CategoryOf : ARRAY[0..479]" in text
