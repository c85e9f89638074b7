"""A Python function as a tree of the language; what the language has not is refused with its line.

The language: assignments to names and to members, `if`, `while`, calls of other programs as statements, at most one
`return`, of names, at the end. Numbers: + - * / and comparisons, `and`, `or`, `not`, `min`, `max`; `f32`, which rounds
a reading and makes a REAL of a whole number, `int`, which makes a whole number of a REAL that is one; named constants
of the module (float32 or whole), and whole numbers. No literal with a decimal point: in Python it would be a double. A
reading may be compared as it is, and is rounded by `f32` before any arithmetic. Both sides of `and` and `or` may be
evaluated: no index may depend on the other side.
"""

from __future__ import annotations

import ast
import inspect
import io
import textwrap
import tokenize
from collections.abc import Callable, Mapping
from functools import cache
from itertools import pairwise
from typing import Any, NoReturn, get_args, get_type_hints

import numpy as np

from tuning_tables.language.records import Kind, Member, Record, record_of
from tuning_tables.language.tree import (
    Ask,
    Assign,
    Binary,
    Compare,
    Convert,
    Expression,
    Extreme,
    If,
    Item,
    Logic,
    Name,
    Not,
    Number,
    Parameter,
    Program,
    Room,
    Statement,
    While,
)

SIGNS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}
COMPARISONS = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}
SHORT = {"MINUS_ONE", "NOUGHT", "HALF", "ONE", "TWO"}
"""Constants that every compiler holds alike, whatever its precision: they stand as numbers."""


class NotOfTheLanguage(ValueError):
    """A function uses what the language has not."""


@cache
def program_of(function: Callable[..., Any]) -> Program:
    """The program that a Python function is. Raises `NotOfTheLanguage`."""
    return _Reader(function).program()


class _Reader:
    """One function while it is read."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = function
        source = textwrap.dedent(inspect.getsource(function))
        (self.tree,) = ast.parse(source).body
        tokens = tokenize.generate_tokens(io.StringIO(source).readline)
        self.comments = {each.start[0]: each.string[1:].strip() for each in tokens if each.type == tokenize.COMMENT}
        self.globals: Mapping[str, Any] = function.__globals__
        self.parameters = tuple(self.parameter(*each) for each in get_type_hints(function, include_extras=True).items()
                                if each[0] != "return")  # fmt: skip
        self.records: dict[str, Record] = {each.name: each.record for each in self.parameters if each.record}
        self.kinds: dict[str, Kind] = {each.name: each.kind for each in self.parameters if each.kind}
        self.readings = {each.name for each in self.parameters if each.is_reading}
        self.given = {each.name for each in self.parameters}

    def program(self) -> Program:
        """The whole function."""
        assert isinstance(self.tree, ast.FunctionDef)
        *statements, last = self.tree.body[1 if ast.get_docstring(self.tree) else 0 :]
        value = last.value if isinstance(last, ast.Return) else None
        body = self.block(statements if value is not None else [*statements, last])
        each = value.elts if isinstance(value, ast.Tuple) else [value] if value is not None else []
        answers = tuple(self.expression(node) for node in each)
        if not all(isinstance(answer, Name) for answer in answers):
            self.refuse(last, "only names are returned")
        note = inspect.getdoc(self.function) or ""
        return Program(self.tree.name, note, self.parameters, body, tuple(a for a in answers if isinstance(a, Name)))

    def parameter(self, name: str, hint: Any) -> Parameter:
        """A parameter by its annotation."""
        for each in get_args(hint):
            if isinstance(each, Member):
                return Parameter(name, each.kind, None, each.meaning, each.is_reading)
            if isinstance(each, Record):
                return Parameter(name, None, each)
        if isinstance(hint, type) and hasattr(hint, "_fields"):
            return Parameter(name, None, record_of(hint))
        raise NotOfTheLanguage(f"{self.function.__qualname__}: the parameter {name} is neither a number nor a record.")

    def refuse(self, node: ast.AST, why: str) -> NoReturn:
        """Raise for what the language has not."""
        line = self.function.__code__.co_firstlineno + getattr(node, "lineno", 1) - 1
        raise NotOfTheLanguage(f"{self.function.__code__.co_filename}:{line}: {why}: {ast.unparse(node)}")

    def block(self, nodes: list[ast.stmt]) -> tuple[Statement, ...]:
        """Statements one after the other."""
        return tuple(self.statement(node) for node in nodes)

    def comment(self, node: ast.stmt) -> str:
        """The comment that stands in the lines above a statement."""
        lines: list[str] = []
        at = node.lineno - 1
        while at in self.comments:
            lines.insert(0, self.comments[at])
            at -= 1
        return " ".join(lines)

    def statement(self, node: ast.stmt) -> Statement:
        """One statement."""
        comment = self.comment(node)
        match node:
            case ast.Assign(targets=[target], value=ast.Call(func=ast.Name(id=name)) as call) if self.is_program(name):
                return self.ask(target, self.globals[name], call, comment)
            case ast.Expr(value=ast.Call(func=ast.Name(id=name)) as call) if self.is_program(name):
                return self.ask(None, self.globals[name], call, comment)
            case ast.Assign(targets=[target], value=given):
                value = self.expression(given)
                if isinstance(target, ast.Name):
                    if self.kinds.setdefault(target.id, value.kind) is not value.kind:
                        self.refuse(node, f"{target.id} changes its kind")
                    if target.id in self.given:
                        self.refuse(node, "a parameter is assigned")
                left = self.expression(target)
                if not isinstance(left, Name | Item):
                    self.refuse(node, "neither a name nor a member is assigned")
                if left.kind is not value.kind and not _is_whole_for(left.kind, value):
                    self.refuse(node, f"a {value.kind.name} is assigned to a {left.kind.name}")
                return Assign(left, value, comment)
            case ast.If():
                branches, rest = [], node
                while True:
                    branches.append((self.condition(rest.test), self.block(rest.body)))
                    match rest.orelse:
                        case [ast.If() as following]:
                            rest = following
                        case other:
                            return If(tuple(branches), self.block(other), comment)
            case ast.While(test=test, body=body, orelse=[]):
                return While(self.condition(test), self.block(body), comment)
        self.refuse(node, "this statement is not of the language")

    def is_program(self, name: str) -> bool:
        """Whether the name is another program."""
        return inspect.isfunction(self.globals.get(name)) and name != "f32"

    def ask(self, target: ast.expr | None, function: Callable[..., Any], call: ast.Call, comment: str) -> Ask:
        """A call of another program."""
        asked = program_of(function)
        targets = () if target is None else tuple(target.elts) if isinstance(target, ast.Tuple) else (target,)
        if len(call.args) != len(asked.parameters) or call.keywords or len(targets) not in (0, len(asked.answers)):
            self.refuse(call, f"{asked.name} has other parameters or answers")
        names = []
        for each, answer in zip(targets, asked.answers, strict=bool(targets)):
            if not isinstance(each, ast.Name) or self.kinds.setdefault(each.id, answer.kind) is not answer.kind:
                self.refuse(call, "an answer goes to a name of its kind")
            names.append(Name(each.id, answer.kind))
        arguments: list[Expression | str] = []
        for argument, parameter in zip(call.args, asked.parameters, strict=True):
            if parameter.record is None:
                arguments.append(self.expression(argument))
            elif isinstance(argument, ast.Name) and self.records.get(argument.id) == parameter.record:
                arguments.append(argument.id)
            else:
                self.refuse(call, f"{parameter.name} is another record")
        return Ask(tuple(names), asked, tuple(arguments), comment)

    def condition(self, node: ast.expr) -> Expression:
        """A condition."""
        found = self.expression(node)
        if found.kind is not Kind.BOOL:
            self.refuse(node, "this is no condition")
        return found

    def expression(self, node: ast.expr) -> Expression:
        """An expression, with its kind."""
        match node:
            case ast.Constant(value=bool(truth)):
                return Number(int(truth), Kind.BOOL)
            case ast.Constant(value=int(whole)):
                return Number(whole, Kind.INT)
            case ast.Name(id=name) if name in self.kinds:
                return Name(name, self.kinds[name])
            case ast.Name(id=name) if name in self.globals:
                return self.constant(node, self.globals[name])
            case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int(whole))):
                return Number(-whole, Kind.INT)
            case ast.UnaryOp(op=ast.Not(), operand=inner):
                return Not(self.condition(inner))
            case ast.Attribute() | ast.Subscript():
                return self.item(node)
            case ast.BinOp(left=left, op=op, right=right) if type(op) in SIGNS:
                return self.binary(node, SIGNS[type(op)], left, right)
            case ast.Compare(left=left, ops=ops, comparators=right):
                return self.comparisons(node, [left, *right], [COMPARISONS.get(type(op), "") for op in ops])
            case ast.BoolOp(op=op, values=values):
                return _joined(isinstance(op, ast.And), [self.condition(each) for each in values])
            case ast.Call(func=ast.Name(id="f32"), args=[inner]):
                value = self.expression(inner)
                return value if value.kind is Kind.REAL else Convert(value, Kind.REAL)
            case ast.Call(func=ast.Name(id="int"), args=[inner]):
                return Convert(self.expression(inner), Kind.INT)
            case ast.Call(func=ast.Name(id=("min" | "max") as name), args=[left, right]):
                low, high = self.expression(left), self.expression(right)
                if low.kind is not high.kind:
                    self.refuse(node, "both must be of one kind")
                return Extreme(name == "max", low, high, low.kind)
        self.refuse(node, "this expression is not of the language")

    def constant(self, node: ast.Name, value: Any) -> Number:
        """A constant of the module."""
        if isinstance(value, np.float32):
            return Number(float(value), Kind.REAL, "" if node.id in SHORT else node.id)
        if isinstance(value, int):
            return Number(int(value), Kind.INT)
        self.refuse(node, "a constant is a float32 or whole")

    def binary(self, node: ast.expr, sign: str, left: ast.expr, right: ast.expr) -> Binary:
        """An operation; of REAL no reading that is not rounded takes part."""
        sides = self.expression(left), self.expression(right)
        if (
            sides[0].kind is not sides[1].kind
            or sides[0].kind is Kind.BOOL
            or (sign == "/" and sides[0].kind is Kind.INT)
        ):
            self.refuse(node, "both sides must be REAL, or whole and not divided")
        for side in (left, right):
            if isinstance(side, ast.Name) and side.id in self.readings:
                self.refuse(node, f"{side.id} is a reading; round it with f32 first")
        return Binary(sign, *sides, sides[0].kind)

    def comparisons(self, node: ast.expr, sides: list[ast.expr], signs: list[str]) -> Expression:
        """One comparison, or several in a row."""
        values = [self.expression(side) for side in sides]
        if "" in signs or len({value.kind for value in values}) != 1:
            self.refuse(node, "both sides must be of one kind")
        each = tuple(Compare(sign, *pair) for sign, pair in zip(signs, pairwise(values), strict=True))
        return each[0] if len(each) == 1 else Logic(True, each)

    def item(self, node: ast.Attribute | ast.Subscript) -> Expression:
        """A member, an element of one, the place of a state, or the length of an axis."""
        match node:
            case ast.Subscript(value=ast.Attribute(value=ast.Attribute(attr=member), attr="shape"),
                               slice=ast.Constant(value=int(axis))):  # fmt: skip
                owner = node.value.value.value  # type: ignore[attr-defined]
                if isinstance(owner, ast.Name) and owner.id in self.records:
                    return Room(owner.id, member, axis)
            case ast.Attribute(value=ast.Name(id=record), attr=member) if record in self.records:
                found = self.member(node, record, member)
                if not found.axes:
                    return Item(record, member, (), found.kind)
            case ast.Subscript(value=ast.Attribute(value=ast.Name(id=record), attr=member), slice=index) if (
                record in self.records
            ):
                found = self.member(node, record, member)
                each = index.elts if isinstance(index, ast.Tuple) else [index]
                indices = tuple(self.expression(one) for one in each)
                if len(indices) == len(found.axes) and all(one.kind is Kind.INT for one in indices):
                    return Item(record, member, indices, found.kind)
            case ast.Subscript(value=ast.Name(id=record), slice=ast.Name(id=place)) if record in self.records:
                found = self.member(node, record, place.lower())
                if self.globals.get(place) == self.records[record].place(place.lower()):
                    return Item(record, place.lower(), (), found.kind)
        self.refuse(node, "this is no member")

    def member(self, node: ast.expr, record: str, member: str) -> Member:
        """The declaration of a member."""
        members = self.records[record].members
        if member not in members:
            self.refuse(node, f"{record} has no member {member}")
        return members[member]


def _is_whole_for(kind: Kind, value: Expression) -> bool:
    """Whether a whole number that stands as it is may go to a member of this kind."""
    return kind is Kind.REAL and isinstance(value, Number) and value.kind is Kind.INT


def _joined(is_all: bool, values: list[Expression]) -> Logic:
    """All of the values, or any; what is joined alike already is taken apart."""
    each = [one.values if isinstance(one, Logic) and one.is_all is is_all else (one,) for one in values]
    return Logic(is_all, tuple(value for part in each for value in part))
