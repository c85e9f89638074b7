"""Self-tests find nothing wrong in the export under any compiler, and find it where one thing in it is wrong."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from typing import TypeAlias

import numpy as np
import pytest

from tests.controller_code.sample_book import approaching_book, surface_book
from tests.effort import every
from tests.tuning_tables.st.conftest import shaped_book, texts_of
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.exported_forms import FORMS, Form, Outcome, self_tested
from tests.tuning_tables.st.storage import Fault
from tests.tuning_tables.st.syntax import (
    BINARY32,
    COMPILERS,
    DOUBLE,
    FUSING,
    Compiler,
    Node,
    faults,
    name_of,
    parse,
    part,
    walk,
    word,
)
from tuning_tables.exports import SELF_TEST_FILE, TABLE_FILE
from tuning_tables.golden_vectors import FEW, few_golden_vectors, golden_vectors
from tuning_tables.self_test_size import SMALL
from tuning_tables.table_book import TableBook

Change: TypeAlias = Callable[[str], str]
"""Changes the text of the tables."""

OUTPUTS = ("DONE", "FAILED", "FIRSTFAILED", "FIRSTFAULT")
MOST_CALLS = 200


def run_all(
    files: Mapping[str, bytes],
    change: Change = lambda tables: tables,
    compiler: Compiler = BINARY32,
    until_found: bool = False,
) -> dict[str, int]:
    """The outputs of RETARDER_SELF_TEST when it is done, or once it has found something."""
    tables = change(files[TABLE_FILE].decode("ascii")).encode("ascii")
    program = Program(tables + files[SELF_TEST_FILE], compiler)
    instance = program.new("RETARDER_SELF_TEST")
    for _ in range(MOST_CALLS):
        program.call("RETARDER_SELF_TEST", instance, Restart=False)
        if instance["DONE"].value or (until_found and instance["FAILED"].value > 0):
            break
    return {name: instance[name].value.item() for name in OUTPUTS}


def surfaces() -> TableBook:
    """Three targets of a class with approach, slopes and estimators."""
    return TableBook(surface_book(approaching_book()).tables[:3])


def test_the_largest_table_is_tested_in_parts() -> None:
    test = texts_of(shaped_book(32, 1))[SELF_TEST_FILE]
    assert test.count(b": RETARDER_TEST_DECISIONS_0") > 1  # more questions than one array may have
    assert faults(parse(test)) == []


def test_it_takes_a_call_a_part_and_can_be_repeated(small_book: TableBook) -> None:
    program = Program(b"".join(texts_of(small_book, SMALL).values()))
    instance, seen = program.new("RETARDER_SELF_TEST"), []
    parts = len(re.findall(r"^    Test_\d+ : ", texts_of(small_book, SMALL)[SELF_TEST_FILE].decode(), re.MULTILINE))
    for restart in [False] * (parts + 1) + [True] + [False] * parts:
        program.call("RETARDER_SELF_TEST", instance, Restart=restart)
        seen.append(instance["DONE"].value.item())
    assert seen == [False] * (parts - 1) + [True, True] + [False] * (parts - 1) + [True, True]


def test_the_questions_left_out_are_those_without_a_portable_literal(default_book: TableBook) -> None:
    text = texts_of(default_book)[SELF_TEST_FILE].decode("ascii")
    numbers = [int(count) for count in re.findall(r"(\d+) golden decisions of table", text)]
    for source, count in zip(default_book.tables, numbers, strict=True):
        vectors = golden_vectors(source)
        portable = np.ones(len(vectors), bool)
        for values in (vectors.s_m, vectors.v_m_s):
            tiny = (np.abs(values) < np.finfo(np.float32).smallest_normal) & (values != 0)
            portable &= np.isfinite(values) & ~tiny & ~((values == 0) & np.signbit(values))
        assert count == np.count_nonzero(portable) > 0.65 * len(vectors)
    assert not re.search(r"(?i)\bnan\b|\binf\b|E-(39|4\d)", re.sub(r"\(\*.*?\*\)", "", text, flags=re.DOTALL))


def test_a_small_self_test_has_few_readings_a_line(
    book: TableBook, default_book: TableBook, estimating_book: TableBook
) -> None:
    for each in (book, default_book, estimating_book, surfaces(), shaped_book(2, 0), shaped_book(32, 9)):
        for table in each.tables:
            vectors = few_golden_vectors(table)
            assert len(vectors) <= FEW * np.count_nonzero(table.has_line)
            assert (vectors.answer == vectors.stage).any()


def constants_in(text: str) -> Iterator[tuple[str, int, int]]:
    """Name of the array and span of every number in constant arrays."""
    number = re.compile(r"-?\d+\.\d+(?:E[+-]\d+)?|-?\d+")
    for array in re.finditer(r"^    (\w+) : ARRAY\[.*?:= \[(.*?)\];", text, re.MULTILINE | re.DOTALL):
        yield from ((array[1], *found.span()) for found in number.finditer(text, *array.span(2)))


def another(literal: str) -> str:
    """A literal of the same kind, and another value."""
    if "." not in literal:
        return str(int(literal) + 1) if int(literal) != 1 else "0"
    # A digit that makes one float32 step: the seventh or eighth counts.
    step = np.nextafter(np.float32(literal), np.float32(np.inf))
    return f"{step:.9E}" if float(literal) else "1.000000000E-01"


@pytest.mark.requirement("CODE-06")
@pytest.mark.parametrize("made", every(2, ["small", "surfaces"]))
def test_a_small_self_test_finds_every_changed_constant(small_book: TableBook, made: str) -> None:
    """Of a book with approach, slopes and estimators one number of each array, of a small one all."""
    files = texts_of(small_book if made == "small" else surfaces(), SMALL)
    text = files[TABLE_FILE].decode("ascii")
    spans = list(constants_in(text))
    if made == "surfaces":
        # The last number that is not 0: arrays are filled up with zeros.
        told = {(name, text.rfind("FUNCTION_BLOCK", 0, begin)): (name, begin, end) for name, begin, end in spans
                if float(text[begin:end]) != 0.0}  # fmt: skip
        spans = list(told.values())
    assert len(spans) > 40
    missed = []
    for name, begin, end in spans:

        def change(tables: str, begin: int = begin, end: int = end) -> str:
            return tables[:begin] + another(tables[begin:end]) + tables[end:]

        if run_all(files, change, until_found=True)["FAILED"] == 0:
            missed.append(name)
    assert missed == []


@pytest.mark.requirement("CODE-06")
@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("Speed < Lower", "Speed <= Lower"),
        ("Speed > Upper", "Speed >= Upper"),
        ("Path := Table.PathMin_m", "Path := Path_m"),
        ("Line := Line + Table", "Line := Line - Table"),
        ("Remaining := Table.Stages - 1;", "Remaining := 1;"),
        ("Before := Answer;", "Before := 0;"),
        ("(Path >= 0.0)", "(Path > 0.0)"),
        ("Above := Pressure - Table.Pressure_kpa[Stage];", "Above := Pressure;"),
        ("IF Table.AtAnyTime = 1 THEN", "IF FALSE THEN"),
        ("Table.FamilyNo = Faster.FamilyNo", "Table.Axles = Faster.Axles"),
        ("Weight := Weight / Span;", "Weight := 0.5;"),
        ("Gained := Gained - Held_1;", "Gained := Gained + Held_1;"),
        ("How := 2;", "How := 1;"),
        ("Raised := Raised + 2;", "Raised := Raised + 4;"),
        ("Status := 0;", "Status := 2;"),
        ("Heaviest := MassOf[Number];", "Heaviest := 0.0;"),
        ("Table.Target_m_s := Commanded_m_s;", ""),
    ],
)
def test_one_changed_statement_is_found(book: TableBook, right: str, wrong: str) -> None:
    """In a book with surfaces, or with tables at rest, of several masses and shapes; or something has no result."""
    names = ("light-2.0", "light-3.3", "shadow-1.5", "turning")
    at_rest = TableBook(tuple(table for table in book.tables if table.id in names))
    texts = [texts_of(each, SMALL) for each in (surfaces(), at_rest)]
    asked = [files for files in texts if right in files[TABLE_FILE].decode("ascii")]
    assert asked

    def is_found(files: Mapping[str, bytes]) -> bool:
        try:
            return run_all(files, lambda tables: tables.replace(right, wrong), until_found=True)["FAILED"] > 0
        except Fault:
            return True

    assert any(map(is_found, asked))


def test_a_fused_multiplication_and_addition_is_found(default_book: TableBook) -> None:
    """One statement instead of two, and one rounding: what a compiler makes of both when it fuses them."""

    def change(tables: str) -> str:
        fused = re.sub(r"Line := Line \* Path;\s+Line := Line \+ (Table.*?\]);", r"Line := Line * Path + \1;", tables)
        assert fused.count("Line * Path +") == 1
        return fused

    files = texts_of(TableBook(default_book.tables[:1]))
    assert run_all(files, change)["FAILED"] == 0  # two roundings, as the statement is written
    assert run_all(files, change, DOUBLE)["FAILED"] == run_all(files, change, FUSING)["FAILED"]
    assert run_all(files, change, FUSING)["FAILED"] == 1


text_of = cache(Form.text)


@cache
def right(form: Form) -> Outcome:
    """The outcome in binary32, without a fault of the compiler."""
    return self_tested(form, text_of(form), BINARY32)


@pytest.mark.requirement("CODE-10")
@pytest.mark.parametrize(
    ("form", "compiler"),
    [
        pytest.param(
            form,
            compiler,
            marks=() if (i + j) % len(COMPILERS) == 0 else pytest.mark.long,
            id=f"{form.name}-{name_of(compiler)}",
        )
        for i, form in enumerate(FORMS)
        for j, compiler in enumerate(COMPILERS)
    ],
)
def test_every_form_finds_nothing_wrong_under_every_compiler(form: Form, compiler: Compiler) -> None:
    """And executes the same operations: a self-test that leaves out what it should ask would find nothing either."""
    found = right(form) if compiler is BINARY32 else self_tested(form, text_of(form), compiler)
    assert found.outputs == (0, -1)
    assert found.done == right(form).done


def short_loops(root: Node) -> Iterator[str]:
    """Heads of FOR loops that turn once or not at all, or whose ends only the controller knows."""
    for node in (each for each in walk(root) if each.type == "for_statement"):
        start, end = (part(node, field) for field in ("start", "end"))
        step = node.child_by_field_name("step")
        are_known = {start.type, end.type} == {"integer_literal"}
        turns_after_first = (int(word(end)) - int(word(start))) // int(word(step) if step else 1) if are_known else 0
        if turns_after_first < 1:
            yield node.text.decode("ascii").partition("DO")[0]


def long_literals(node: Node) -> Iterator[str]:
    """Real literals in statements that are another number in double precision than in binary32."""
    if node.type == "variable_declaration":
        return
    if node.type == "real_literal" and float(word(node)) != float(np.float32(word(node))):
        yield word(node)
    for child in node.children:
        yield from long_literals(child)


def blocks_of(form: Form, is_test: bool) -> Iterator[Node]:
    """The blocks of the self-test, or all others."""
    for node in parse(text_of(form)).named_children:
        if node.type == "function_block_declaration":
            name = word(part(node, "name"))
            if is_test == ("_TEST" in name or name.endswith("_CHOICES")):
                yield node


SIDES = pytest.mark.parametrize("is_test", [False, True], ids=["tables", "self-test"])
EACH = pytest.mark.parametrize("form", FORMS, ids=lambda form: form.name)


@pytest.mark.requirement("CODE-10")
@EACH
@SIDES
def test_no_for_may_turn_once_or_never(form: Form, is_test: bool) -> None:
    assert [loop for block in blocks_of(form, is_test) for loop in short_loops(block)] == []


@pytest.mark.requirement("CODE-10")
@EACH
@SIDES
def test_no_literal_in_a_statement_is_rounded_by_real(form: Form, is_test: bool) -> None:
    assert [literal for block in blocks_of(form, is_test) for literal in long_literals(block)] == []


@pytest.mark.parametrize(
    ("loop", "is_short"),
    [("0 TO 1", False), ("1 TO 0 BY -1", False), ("0 TO 4 BY 2", False), ("0 TO 0", True), ("1 TO 0", True),
     ("0 TO 1 BY -1", True), ("0 TO 1 BY 2", True), ("0 TO I", True), ("I TO 9", True), ("2 - 1 TO 9", True)],
)  # fmt: skip
def test_a_short_loop_is_seen(loop: str, is_short: bool) -> None:
    text = f"FUNCTION_BLOCK F IF B THEN FOR K := {loop} DO J := 1; END_FOR; END_IF; END_FUNCTION_BLOCK"
    assert [*short_loops(parse(text.encode("ascii")))] == ([f"FOR K := {loop} "] if is_short else [])


@pytest.mark.parametrize(
    ("literal", "is_long"),
    [("0.5", False), ("-1.0", False), ("1.677721600E+07", False), ("0.2", True), ("3.4028235E+38", True),
     ("-1.199999973E-01", True), ("2.000000030E-01", True), ("16777217.0", True)],
)  # fmt: skip
def test_a_long_literal_is_seen_but_in_a_constant(literal: str, is_long: bool) -> None:
    text = f"FUNCTION_BLOCK F VAR CONSTANT C : REAL := {literal}; END_VAR B := X >= {literal}; END_FUNCTION_BLOCK"
    assert [*long_literals(parse(text.encode("ascii")))] == ([literal] if is_long else [])
