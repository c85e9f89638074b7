"""The self-test blocks find nothing wrong in the export, and find it where one thing in it is wrong."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from typing import TypeAlias

import numpy as np
import pytest

from tests.tuning_tables.st.compiler import BINARY32, DOUBLE, ROUNDINGS, Compiler, name_of
from tests.tuning_tables.st.conftest import shaped_book, texts_of
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.storage import Fault
from tuning_tables.distinct_estimators import distinct_estimators
from tuning_tables.golden_vectors import FEW, few_golden_vectors, golden_vectors
from tuning_tables.self_test_size import FULL, SMALL, SelfTestSize
from tuning_tables.st_source import SELF_TEST_FILE, TABLE_FILE
from tuning_tables.table_book import TableBook

Change: TypeAlias = Callable[[str, str], tuple[str, str]]
"""Changes the texts of the tables and of the self-test."""

OUTPUTS = ("DONE", "FAILED", "FIRSTFAILED", "FIRSTFAULT")


def calls_of(book: TableBook) -> int:
    """Of the self-test: one a table, one for the choice, one an estimator, and one for the tables without any."""
    return len(book.tables) + 1 + len(distinct_estimators(book).first_tables)


def run_all(
    files: Mapping[str, bytes],
    calls: int,
    change: Change = lambda tables, test: (tables, test),
    compiler: Compiler = BINARY32,
) -> dict[str, int]:
    """The outputs after that many calls of RETARDER_SELF_TEST, with the two texts changed."""
    texts = change(files[TABLE_FILE].decode("ascii"), files[SELF_TEST_FILE].decode("ascii"))
    program = Program("".join(texts).encode("ascii"), compiler)
    instance = program.new("RETARDER_SELF_TEST")
    for _ in range(calls):
        program.call("RETARDER_SELF_TEST", instance, Restart=False)
    return {name: instance[name].value.item() for name in OUTPUTS}


def run_until_found(files: Mapping[str, bytes], calls: int, change: Change) -> dict[str, int]:
    """As `run_all`, but no call after the one that finds something: it counts on from there, and takes nothing back.

    That it goes on to its end then, and that what it has found stays, is tested where one constant is changed.
    """
    texts = change(files[TABLE_FILE].decode("ascii"), files[SELF_TEST_FILE].decode("ascii"))
    program = Program("".join(texts).encode("ascii"))
    instance = program.new("RETARDER_SELF_TEST")
    for _ in range(calls):
        program.call("RETARDER_SELF_TEST", instance, Restart=False)
        if instance["FAILED"].value > 0:
            break
    return {name: instance[name].value.item() for name in OUTPUTS}


@pytest.mark.parametrize("compiler", ROUNDINGS, ids=name_of)
def test_nothing_is_wrong_with_the_export(
    default_book: TableBook, estimating_book: TableBook, compiler: Compiler
) -> None:
    sound = {"DONE": True, "FAILED": 0, "FIRSTFAILED": -1, "FIRSTFAULT": -1}
    for book in (default_book, estimating_book):
        assert run_all(texts_of(book), calls_of(book), compiler=compiler) == sound


def test_nothing_is_wrong_with_other_shapes(book: TableBook) -> None:
    assert run_all(texts_of(book), calls_of(book))["FAILED"] == 0
    large = shaped_book(32, 1)
    files = texts_of(large)
    assert b"Stage_1 : " in files[SELF_TEST_FILE]  # more vectors than one array may have
    assert run_all(files, calls_of(large)) == {"DONE": True, "FAILED": 0, "FIRSTFAILED": -1, "FIRSTFAULT": -1}


def test_it_takes_a_call_a_part_and_can_be_repeated(small_book: TableBook) -> None:
    program = Program(b"".join(texts_of(small_book).values()))
    instance = program.new("RETARDER_SELF_TEST")
    seen = []
    for restart in (False, False, False, False, False, True, False, False, False):
        program.call("RETARDER_SELF_TEST", instance, Restart=restart)
        seen.append(instance["DONE"].value.item())
    assert seen == [False, False, False, True, True, False, False, False, True]


def test_the_vectors_left_out_are_those_without_a_portable_literal(default_book: TableBook) -> None:
    text = texts_of(default_book)[SELF_TEST_FILE].decode("ascii")
    numbers = [int(count) for count in re.findall(r"constants and (\d+) readings", text)]
    for source, count in zip(default_book.tables, numbers, strict=True):
        vectors = golden_vectors(source)
        portable = np.ones(len(vectors), bool)
        for values in (vectors.s_m, vectors.v_m_s):
            tiny = (np.abs(values) < np.finfo(np.float32).smallest_normal) & (values != 0)
            portable &= np.isfinite(values) & ~tiny & ~((values == 0) & np.signbit(values))
        assert count == np.count_nonzero(portable) > 0.65 * len(vectors)
    assert not re.search(r"(?i)\bnan\b|\binf\b|E-(39|4\d)", re.sub(r"\(\*.*?\*\)", "", text, flags=re.DOTALL))


def test_a_small_self_test_has_few_readings_a_line_and_finds_nothing_wrong(
    book: TableBook, default_book: TableBook, estimating_book: TableBook
) -> None:
    for each in (book, default_book, estimating_book, shaped_book(2, 0), shaped_book(32, 9)):
        for table in each.tables:
            vectors = few_golden_vectors(table)
            assert len(vectors) <= FEW * np.count_nonzero(table.has_line)
            assert (vectors.answer == vectors.stage).any()
        assert run_all(texts_of(each, SMALL), calls_of(each))["FAILED"] == 0


def constants_in(text: str) -> Iterator[tuple[int, int]]:
    """Spans of all numbers in constant arrays."""
    number = re.compile(r"-?\d+\.\d+(?:E[+-]\d+)?|-?\d+|TRUE|FALSE")
    for array in re.finditer(r"^    \w+ : ARRAY\[.*?:= \[(.*?)\];", text, re.MULTILINE | re.DOTALL):
        yield from (found.span() for found in number.finditer(text, *array.span(1)))


def test_a_small_self_test_finds_every_changed_constant(small_book: TableBook) -> None:
    files, calls = texts_of(small_book, SMALL), calls_of(small_book)
    spans = list(constants_in(files[TABLE_FILE].decode("ascii")))
    assert len(spans) == 54
    for begin, end in spans:

        def change(tables: str, test: str, begin: int = begin, end: int = end) -> tuple[str, str]:
            return tables[:begin] + another(tables[begin:end]) + tables[end:], test

        assert run_until_found(files, calls, change)["FAILED"] > 0


def next_number(text: str, after: str, place: int) -> tuple[int, int]:
    """Span of the number at `place` in the array declared by `after`."""
    start = text.index(after) + len(after)
    found = re.compile(r"-?\d+\.\d+(E[+-]\d+)?|-?\d+|TRUE|FALSE")
    matches = list(found.finditer(text, text.index("[", text.index(":=", start)), text.index("];", start)))
    return matches[place].span()


def another(literal: str) -> str:
    """A literal of the same kind, and another value."""
    if literal in ("TRUE", "FALSE"):
        return "FALSE" if literal == "TRUE" else "TRUE"
    if "." not in literal:
        return str(int(literal) + 1) if int(literal) != 1 else "0"
    # A digit that makes one float32 step: the seventh or eighth counts.
    step = np.nextafter(np.float32(literal), np.float32(np.inf))
    return f"{step:.9E}" if float(literal) else "1.000000000E-01"


@pytest.mark.parametrize(
    ("array", "place", "block"),
    [
        ("TargetOf", 1, 1),
        ("PathMinOf", 0, 0),
        ("PathMaxOf", 1, 1),
        ("PowersOf", 0, 0),
        ("Lower_0 ", 1, 0),
        ("Upper_1 ", 0, 1),
        ("Coefficient_0 ", 2, 0),
        ("Coefficient_0 ", 3, 0),
        ("Coefficient_1 ", 0, 1),
        ("Coefficient_1 ", 4, 1),
        ("RETARDER_SELECT\nCategoryOf", 0, 2),
        ("RETARDER_SELECT\nAxlesOf", 1, 2),
        ("RETARDER_SELECT\nMassOf", 0, 2),
        ("RETARDER_SELECT\nTargetOf", 1, 2),
    ],
)
@pytest.mark.parametrize("self_test", [FULL, SMALL], ids=["full", "small"])
def test_one_changed_constant_is_found(
    small_book: TableBook, array: str, place: int, block: int, self_test: SelfTestSize
) -> None:
    def change(tables: str, test: str) -> tuple[str, str]:
        head, _, name = array.rpartition("\n")
        offset = tables.index(f"FUNCTION_BLOCK {head}") if head else 0
        begin, end = (offset + index for index in next_number(tables[offset:], name, place))
        assert another(tables[begin:end]) != tables[begin:end]
        return tables[:begin] + another(tables[begin:end]) + tables[end:], test

    outputs = run_all(texts_of(small_book, self_test), calls_of(small_book), change)
    assert outputs["DONE"]
    assert outputs["FAILED"] >= 1
    assert outputs["FIRSTFAILED"] <= block
    assert outputs["FIRSTFAULT"] >= 0


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("Speed_m_s < Line", "Speed_m_s <= Line"),
        ("Speed_m_s > Line", "Speed_m_s >= Line"),
        ("Path := Table.PathMin_m", "Path := Path_m"),
        ("Path := Table.PathMax_m", "Path := Path_m"),
        ("Speed_m_s >= 0.0", "TRUE"),
        ("(Stage < Table.Stages)", "(Stage < 1)"),
        ("Line := Line + Table", "Line := Line - Table"),
        ("Weight := Weight / Span;", "Weight := 0.5;"),
        ("Status := 0;", "Status := 2;"),
    ],
)
@pytest.mark.parametrize("self_test", [FULL, SMALL], ids=["full", "small"])
def test_one_changed_statement_is_found(small_book: TableBook, right: str, wrong: str, self_test: SelfTestSize) -> None:
    def change(tables: str, test: str) -> tuple[str, str]:
        assert right in tables
        return tables.replace(right, wrong), test

    assert run_until_found(texts_of(small_book, self_test), calls_of(small_book), change)["FAILED"] > 0


def test_a_fused_multiplication_and_addition_is_found(default_book: TableBook) -> None:
    """One statement instead of two, and one rounding: what a compiler makes of both when it fuses them."""

    def change(tables: str, test: str) -> tuple[str, str]:
        fused = re.sub(r"Line := Line \* Path;\s+Line := Line \+ (Table.*?\]);", r"Line := Line * Path + \1;", tables)
        assert fused.count("Line * Path +") == 2
        return fused, test

    files, calls = texts_of(default_book), calls_of(default_book)
    assert run_all(files, calls, change)["FAILED"] == 0  # two roundings, as the statement is written
    assert run_all(files, calls, change, DOUBLE)["FAILED"] == len(default_book.tables)


SAME = {
    ("Place > Table.BreakPath_m[Table", " > "), ("Place < Table.BreakPath_m[0]", " < "),
    ("Overpressure_kpa >= 0.0", " >= "), ("Path_m >= Before", " >= "), ("Path_m >= Path)", " >= "),
    ("Mean < Least", " < "), ("Predicted < Least", " < "), ("Way < Least", " < "), ("Speed_m_s < Least", " < "),
    ("Factor < Least", " < "), ("Factor > Largest", " > "), ("FactorVariance < 0.0", " < "),
    ("Table.Breaks < 2", " < "), ("Table.Breaks > 40", " > "), ("Table.Breaks > 16", " > "),  # no such table
    ("Table.Breaks >= 2", " >= "), ("Table.Breaks <= 16", " <= "),
    ("SpeedPart < 0.0", " < "), ("Change < 0.0", " < "), ("Observed_m_s < 0.0", " < "), ("ExcessVariance < 0.0", " < "),
    ("Leap > Most", " > "), ("Leap < Change", " < "), ("Square > Bound", " > "), ("Excess < Change", " < "),
    ("Excess > Largest", " > "), ("SpeedVariance > Table", " > "), ("Change > Table", " > "),
}  # fmt: skip
"""Comparisons where what happens to equal numbers changes nothing, or which only a spoilt table can fail."""


def swapped_operators(code: str) -> Iterator[tuple[str, str]]:
    """(line, code) with one operator of an assignment or comparison turned into another, each in its turn."""
    swapped = {"+": "-", "-": "+", "*": "/", "/": "*", "<": "<=", ">": ">=", "<=": "<", ">=": ">"}
    for match in re.finditer(r" ([-+*/<>]|[<>]=) ", code):
        line = code[code.rfind("\n", 0, match.start()) + 1 : code.index("\n", match.start())]
        around = code[match.start() - 30 : match.end() + 32]
        is_comment = code.rfind("(*", 0, match.start()) > code.rfind("*)", 0, match.start())
        if not is_comment and not any(part in around and operator == match[0] for part, operator in SAME):
            yield line.strip(), f"{code[: match.start()]} {swapped[match[1]]} {code[match.end() :]}"


@pytest.mark.slow
def test_every_wrong_operation_of_the_estimator_is_found(estimating_book: TableBook) -> None:
    """By the golden tracks in the self-test, or by an operation that has no result."""
    book = TableBook(estimating_book.tables[:1])
    files = texts_of(book)
    text, tests = (files[name].decode("ascii") for name in (TABLE_FILE, SELF_TEST_FILE))
    begin, end = (text.index(f"FUNCTION_BLOCK RETARDER_{name}") for name in ("WORK", "DECIDE"))
    test = tests[tests.index("FUNCTION_BLOCK RETARDER_TEST_ESTIMATOR_0") : tests.index("FUNCTION_BLOCK RETARDER_SELF")]

    def failed(code: str) -> bool:
        try:
            program = Program((text[:begin] + code + text[end:] + test).encode("ascii"))
            loader, table, tester = (program.new(f"RETARDER_{name}") for name in ("LOAD", "TABLE", "TEST_ESTIMATOR_0"))
            program.call("RETARDER_LOAD", loader, TableNo=0, Table=table)
            program.call("RETARDER_TEST_ESTIMATOR_0", tester, Table=table)
            return bool(tester["FAILED"].value > 0)
        except Fault:
            return True

    assert not failed(text[begin:end])
    changes = list(swapped_operators(text[begin:end]))
    assert len(changes) > 60
    assert [line for line, code in changes if not failed(code)] == []


@pytest.mark.parametrize(
    ("array", "place"),
    [("TouchOf", 0), ("EstimatorOf", 1), ("BreaksOf", 0), ("SpeedVarianceOf", 0), ("FactorVarianceOf", 1),
     ("PathVarianceOf", 0), ("ExcessVarianceOf", 1), ("LeapOf", 0), ("FrozenOf", 0), ("DoubtedOf", 1),
     ("LostVarianceOf", 0), ("CautionOf", 1), ("UnlikelyOf", 0), ("BreakPath_0", 3), ("Drive_0", 15), ("Brake_1", 2)],
)  # fmt: skip
def test_one_changed_constant_of_an_estimator_is_found(estimating_book: TableBook, array: str, place: int) -> None:
    tables = estimating_book.tables[:3]  # the third has the second estimator

    def change(tables: str, test: str) -> tuple[str, str]:
        begin, finish = next_number(tables, f"    {array} ", place)
        return tables[:begin] + another(tables[begin:finish]) + tables[finish:], test

    book = TableBook(tables)
    outputs = run_all(texts_of(book), calls_of(book), change)
    assert outputs["DONE"]
    assert outputs["FAILED"] >= 1
