"""Every exported form answers alike under every compiler, and holds nothing in which compilers are known to differ."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np
import pytest

from tests.tuning_tables.st.compiler import BINARY32, COMPILERS, Compiler, name_of
from tests.tuning_tables.st.exported_forms import FORMS, Form, Outcome, self_tested
from tests.tuning_tables.st.syntax import Node, parse, part, walk, word

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
