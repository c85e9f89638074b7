"""Expressions of Structured Text as functions of (frame, mask): compiled once from the parse tree, run over all lanes.

Strict where compilers differ: no conversion between REAL, INT and BOOL, no overflow of INT, no REAL operation without
a finite result, no division by 0, no index out of range, wherever the mask is true. AND and OR evaluate both sides.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from tests.tuning_tables.st.storage import INT_LIMITS, Array, Fault, Record, Scalar, somewhere
from tests.tuning_tables.st.syntax import parts, word

COMPARISONS = {
    "<": np.less,
    ">": np.greater,
    "<=": np.less_equal,
    ">=": np.greater_equal,
    "=": np.equal,
    "<>": np.not_equal,
}
LOGIC = {"AND": np.logical_and, "OR": np.logical_or, "XOR": np.logical_xor}
ARITHMETIC = {"+": np.add, "-": np.subtract, "*": np.multiply, "/": np.divide}


@dataclass(frozen=True)
class Expression:
    """What an expression is (REAL, INT, BOOL) and how its value follows from the variables."""

    kind: str
    run: Callable


@dataclass
class Arithmetic:
    """How REAL is computed between two assignments, and how often what was done: float32, or float64 to be rounded."""

    real: type = np.float32
    done: Counter = field(default_factory=Counter)


Scope = Mapping[str, object]


def compile_expression(node, scope: Scope, arithmetic: Arithmetic) -> Expression:
    """The expression at `node` of the parse tree, with the types of `scope`."""
    if node.type == "parenthesized_expression":
        return compile_expression(node.named_child(0), scope, arithmetic)
    if node.type in ("integer_literal", "real_literal", "boolean_literal"):
        return _literal(node, arithmetic)
    if node.type == "unary_expression":
        return _unary(node, scope, arithmetic)
    if node.type == "binary_expression":
        return _binary(node, scope, arithmetic)
    if node.type == "index_expression":
        row, index = compile_element(node, scope, arithmetic)
        return Expression(row.kind, _reader(row, index, arithmetic))
    kind, find = resolve(node, scope)
    if not isinstance(kind, Scalar):
        raise Fault(f"{node.text!r} is no number")
    if kind.kind != "REAL":
        return Expression(kind.kind, lambda frame, mask: find(frame).value)
    return Expression("REAL", lambda frame, mask: widened(find(frame).value, arithmetic))


def resolve(node, scope: Scope):
    """Type of a variable, member of a record or variable of a block, and a function from the frame to the variable."""
    if node.type == "identifier":
        name = word(node)
        if name not in scope:
            raise Fault(f"{name} is not declared")
        return scope[name], lambda frame: frame[name]
    if node.type == "member_access_expression":
        kind, find = resolve(node.child_by_field_name("object"), scope)
        member = word(node.child_by_field_name("member"))
        if not isinstance(kind, Record) or kind.members.get(member) is None:
            raise Fault(f"{node.text!r} does not exist")
        return kind.members[member][0], lambda frame: find(frame)[member]
    raise Fault(f"{node.type} is not understood")


@dataclass(frozen=True)
class Element:
    """Where an array is found, and what is in it."""

    kind: str
    find: Callable


def compile_element(node, scope: Scope, arithmetic: Arithmetic) -> tuple[Element, Callable]:
    """An indexed variable: its array, and its index."""
    kind, find = resolve(node.child_by_field_name("object"), scope)
    (index_node,) = parts(node, "index")
    index = compile_expression(index_node, scope, arithmetic)
    if not isinstance(kind, Array) or index.kind != "INT":
        raise Fault(f"{node.text!r} is no element of an array")
    return Element(kind.element.kind, find), index.run


def widened(value, arithmetic: Arithmetic):
    """A stored REAL in the width that is calculated in."""
    return value if value.dtype == arithmetic.real else arithmetic.real(value)


def _reader(row: Element, index: Callable, arithmetic: Arithmetic) -> Callable:
    def run(frame, mask):
        arithmetic.done["element"] += 1
        value = row.find(frame).load(index(frame, mask), mask)
        return widened(value, arithmetic) if row.kind == "REAL" else value

    return run


def _literal(node, arithmetic: Arithmetic) -> Expression:
    text = word(node).replace("_", "")
    if node.type == "boolean_literal":
        value = np.bool_(text == "TRUE")
        return Expression("BOOL", lambda frame, mask: value)
    if node.type == "real_literal":
        number = arithmetic.real(float(text))
        return Expression("REAL", lambda frame, mask: number)
    if not INT_LIMITS[0] <= int(text) <= INT_LIMITS[1]:
        raise Fault(f"{text} is no INT")
    whole = np.int64(text)
    return Expression("INT", lambda frame, mask: whole)


def _unary(node, scope: Scope, arithmetic: Arithmetic) -> Expression:
    operand = compile_expression(node.child_by_field_name("operand"), scope, arithmetic)
    operator = word(node.child_by_field_name("operator"))
    if (operator, operand.kind) == ("NOT", "BOOL"):
        return Expression("BOOL", lambda frame, mask: np.logical_not(operand.run(frame, mask)))
    raise Fault(f"{operator} {operand.kind} is not understood")


def _binary(node, scope: Scope, arithmetic: Arithmetic) -> Expression:
    left = compile_expression(node.child_by_field_name("left"), scope, arithmetic)
    right = compile_expression(node.child_by_field_name("right"), scope, arithmetic)
    operator = word(node.child_by_field_name("operator"))
    if left.kind != right.kind:
        raise Fault(f"{node.text!r} mixes {left.kind} and {right.kind}")
    kind = left.kind
    if operator in ARITHMETIC and kind != "BOOL" and (operator, kind) != ("/", "INT"):
        return Expression(kind, _calculation(operator, kind, left.run, right.run, arithmetic))
    if operator in COMPARISONS and kind != "BOOL":
        return Expression("BOOL", _counted(COMPARISONS[operator], "comparison", left.run, right.run, arithmetic))
    if operator in LOGIC and kind == "BOOL":
        return Expression("BOOL", _counted(LOGIC[operator], "logic", left.run, right.run, arithmetic))
    raise Fault(f"{kind} {operator} {kind} is not understood")


def _counted(operation, name: str, left: Callable, right: Callable, arithmetic: Arithmetic) -> Callable:
    def run(frame, mask):
        arithmetic.done[name] += 1
        return operation(left(frame, mask), right(frame, mask))

    return run


def _calculation(operator: str, kind: str, left: Callable, right: Callable, arithmetic: Arithmetic) -> Callable:
    operation = ARITHMETIC[operator]

    def run(frame, mask):
        arithmetic.done[f"{kind} {operator}"] += 1
        value = operation(left(frame, mask), right(frame, mask))
        low, high = INT_LIMITS
        wrong = ~np.isfinite(value) if kind == "REAL" else (value < low) | (value > high)
        if somewhere(wrong, mask):
            raise Fault(f"{kind} {operator} has no {kind} result")
        return value

    return run
