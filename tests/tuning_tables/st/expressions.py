"""Expressions of Structured Text as functions of (frame, mask): compiled once from the parse tree, run over all lanes.

Strict where compilers differ: REAL and INT become each other by INT_TO_REAL and REAL_TO_INT alone, no overflow of INT,
no REAL operation without a finite result, no division by 0, no index out of range, wherever the mask is true. AND and
OR evaluate both sides.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np

from tests.tuning_tables.st.storage import INT_LIMITS, Array, Fault, Frame, Kind, Mask, Record, Scalar, Value, somewhere
from tests.tuning_tables.st.syntax import BINARY32, Compiler, Node, part, parts, word

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


Evaluate: TypeAlias = Callable[[Frame, Mask], Value]
Find: TypeAlias = Callable[[Frame], Any]
"""Finds a variable in a frame: a `Cell`, `Row` or `Frame`, as its declaration says."""


@dataclass(frozen=True)
class Expression:
    """What an expression is (REAL, INT, BOOL) and how its value follows from the variables."""

    kind: str
    run: Evaluate


@dataclass
class Arithmetic:
    """Who computes, and how often what was done."""

    compiler: Compiler = BINARY32
    done: Counter[str] = field(default_factory=Counter)


Scope: TypeAlias = Mapping[str, Kind]


def compile_expression(node: Node, scope: Scope, arithmetic: Arithmetic) -> Expression:
    """The expression at `node` of the parse tree, with the types of `scope`."""
    if node.type == "parenthesized_expression":
        return compile_expression(node.named_children[0], scope, arithmetic)
    if node.type in ("integer_literal", "real_literal", "boolean_literal"):
        return _literal(node, arithmetic)
    if node.type == "unary_expression":
        return _unary(node, scope, arithmetic)
    if node.type == "binary_expression":
        return _binary(node, scope, arithmetic)
    if node.type == "call_expression":
        return _conversion(node, scope, arithmetic)
    if node.type == "index_expression":
        row, index = compile_element(node, scope, arithmetic)
        return Expression(row.kind, _reader(row, index, arithmetic))
    kind, find = resolve(node, scope)
    if not isinstance(kind, Scalar):
        raise Fault(f"{node.text!r} is no number")
    if kind.kind != "REAL":
        return Expression(kind.kind, lambda frame, mask: find(frame).value)
    return Expression("REAL", lambda frame, mask: widened(find(frame).value, arithmetic))


def resolve(node: Node, scope: Scope) -> tuple[Kind, Find]:
    """Type of a variable, member of a record or variable of a block, and a function from the frame to the variable."""
    if node.type == "identifier":
        name = word(node)
        if name not in scope:
            raise Fault(f"{name} is not declared")
        return scope[name], lambda frame: frame[name]
    if node.type == "member_access_expression":
        kind, find = resolve(part(node, "object"), scope)
        member = word(part(node, "member"))
        if not isinstance(kind, Record) or kind.members.get(member) is None:
            raise Fault(f"{node.text!r} does not exist")
        return kind.members[member][0], lambda frame: find(frame)[member]
    raise Fault(f"{node.type} is not understood")


@dataclass(frozen=True)
class Element:
    """Where an array is found, and what is in it."""

    kind: str
    find: Find


def compile_element(node: Node, scope: Scope, arithmetic: Arithmetic) -> tuple[Element, Evaluate]:
    """An indexed variable: its array, and its index."""
    kind, find = resolve(part(node, "object"), scope)
    (index_node,) = parts(node, "index")
    index = compile_expression(index_node, scope, arithmetic)
    if not isinstance(kind, Array) or index.kind != "INT":
        raise Fault(f"{node.text!r} is no element of an array")
    return Element(kind.element.kind, find), index.run


def widened(value: Value, arithmetic: Arithmetic) -> Value:
    """A stored REAL in the width that is calculated in."""
    between = arithmetic.compiler.between
    return value if value.dtype == between else between(value)


def _reader(row: Element, index: Evaluate, arithmetic: Arithmetic) -> Evaluate:
    def run(frame: Frame, mask: Mask) -> Value:
        arithmetic.done["element"] += 1
        value = row.find(frame).load(index(frame, mask), mask)
        return widened(value, arithmetic) if row.kind == "REAL" else value

    return run


def _literal(node: Node, arithmetic: Arithmetic) -> Expression:
    text = word(node).replace("_", "")
    if node.type == "boolean_literal":
        value = np.bool_(text == "TRUE")
        return Expression("BOOL", lambda frame, mask: value)
    if node.type == "real_literal":
        number = arithmetic.compiler.literals(float(text))
        return Expression("REAL", lambda frame, mask: number)
    if not INT_LIMITS[0] <= int(text) <= INT_LIMITS[1]:
        raise Fault(f"{text} is no INT")
    whole = np.int64(text)
    return Expression("INT", lambda frame, mask: whole)


def _unary(node: Node, scope: Scope, arithmetic: Arithmetic) -> Expression:
    operand = compile_expression(part(node, "operand"), scope, arithmetic)
    operator = word(part(node, "operator"))
    if (operator, operand.kind) == ("NOT", "BOOL"):
        return Expression("BOOL", lambda frame, mask: np.logical_not(operand.run(frame, mask)))
    raise Fault(f"{operator} {operand.kind} is not understood")


def _conversion(node: Node, scope: Scope, arithmetic: Arithmetic) -> Expression:
    """A number of the other kind; REAL_TO_INT rounds to the nearest, as in the standard but not in every compiler."""
    (argument,) = part(node, "arguments").named_children
    value = compile_expression(argument, scope, arithmetic)
    if (word(part(node, "function")), value.kind) == ("INT_TO_REAL", "INT"):
        return Expression("REAL", lambda frame, mask: arithmetic.compiler.between(value.run(frame, mask)))
    if (word(part(node, "function")), value.kind) != ("REAL_TO_INT", "REAL"):
        raise Fault(f"{node.text!r} is not understood")

    def run(frame: Frame, mask: Mask) -> Value:
        nearest = np.rint(value.run(frame, mask))
        is_none = ~((nearest >= INT_LIMITS[0]) & (nearest <= INT_LIMITS[1]))
        if somewhere(is_none, mask):
            raise Fault("REAL_TO_INT has no INT result")
        return np.where(is_none, 0, nearest).astype(np.int64)[()]

    return Expression("INT", run)


def _binary(node: Node, scope: Scope, arithmetic: Arithmetic) -> Expression:
    left = compile_expression(part(node, "left"), scope, arithmetic)
    right = compile_expression(part(node, "right"), scope, arithmetic)
    operator = word(part(node, "operator"))
    if left.kind != right.kind:
        raise Fault(f"{node.text!r} mixes {left.kind} and {right.kind}")
    kind = left.kind
    if operator in ("+", "-") and kind == "REAL" and arithmetic.compiler.fuses:
        for product, other, is_left in ((part(node, "left"), right, True), (part(node, "right"), left, False)):
            factors = _factors(product, scope, arithmetic)
            if factors is not None:
                return Expression(kind, _fused(operator, factors, other.run, is_left, arithmetic))
    if operator in ARITHMETIC and kind != "BOOL" and (operator, kind) != ("/", "INT"):
        return Expression(kind, _calculation(operator, kind, left.run, right.run, arithmetic))
    if operator in COMPARISONS and kind != "BOOL":
        return Expression("BOOL", _counted(COMPARISONS[operator], "comparison", left.run, right.run, arithmetic))
    if operator in LOGIC and kind == "BOOL":
        return Expression("BOOL", _counted(LOGIC[operator], "logic", left.run, right.run, arithmetic))
    raise Fault(f"{kind} {operator} {kind} is not understood")


def _counted(operation: np.ufunc, name: str, left: Evaluate, right: Evaluate, arithmetic: Arithmetic) -> Evaluate:
    def run(frame: Frame, mask: Mask) -> Value:
        arithmetic.done[name] += 1
        return operation(left(frame, mask), right(frame, mask))

    return run


def _calculation(operator: str, kind: str, left: Evaluate, right: Evaluate, arithmetic: Arithmetic) -> Evaluate:
    operation = ARITHMETIC[operator]

    def run(frame: Frame, mask: Mask) -> Value:
        arithmetic.done[f"{kind} {operator}"] += 1
        return _required(operation(left(frame, mask), right(frame, mask)), operator, kind, mask)

    return run


def _required(value: Value, operator: str, kind: str, mask: Mask) -> Value:
    """`value`, which must be a number of its kind where `mask` is true."""
    low, high = INT_LIMITS
    wrong = ~np.isfinite(value) if kind == "REAL" else (value < low) | (value > high)
    if somewhere(wrong, mask):
        raise Fault(f"{kind} {operator} has no {kind} result")
    return value


def _factors(node: Node, scope: Scope, arithmetic: Arithmetic) -> tuple[Evaluate, Evaluate] | None:
    """Both sides of a product, also in brackets; None if `node` is none."""
    if node.type == "parenthesized_expression":
        return _factors(node.named_children[0], scope, arithmetic)
    if node.type != "binary_expression" or word(part(node, "operator")) != "*":
        return None
    left, right = (compile_expression(part(node, side), scope, arithmetic) for side in ("left", "right"))
    return left.run, right.run


def _fused(
    operator: str, factors: tuple[Evaluate, Evaluate], other: Evaluate, product_is_left: bool, arithmetic: Arithmetic
) -> Evaluate:
    """A product and a sum with one rounding, as `Compiler` says."""
    operation = ARITHMETIC[operator]

    def run(frame: Frame, mask: Mask) -> Value:
        arithmetic.done["REAL *"] += 1
        arithmetic.done[f"REAL {operator}"] += 1
        first, second, summand = (np.asarray(each(frame, mask)) for each in (*factors, other))
        narrow, kind = np.result_type(first, second), np.result_type(first, second, summand)
        product = first.astype(np.float64) * second
        if narrow != kind:  # a product of REALs that is widened before the sum
            product = product.astype(narrow)
        sides = (product, summand) if product_is_left else (summand, product)
        return _required(operation(*sides).astype(kind)[()], operator, "REAL", mask)

    return run
