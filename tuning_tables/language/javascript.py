"""Programs as JavaScript, for pages that ask a controller's own rule: one rounding an operation, by `Math.fround`.

A number of JavaScript is a double. The double of a sum, difference, product or quotient of two float32 numbers, rounded
to float32, is what one operation in float32 gives: the digits of a double are more than twice those of a float32, and
two. So decisions and estimates are those of every other language, to the bit.

A record is an object. Its arrays are typed arrays; one with several axes is flat, the last axis first.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping
from typing import Any, Final

import numpy as np

from tuning_tables.language.records import Kind, SizedRecord
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
    Program,
    Room,
    Statement,
    While,
)
from tuning_tables.language.walking import constants_of, variables_of

WIDTH: Final = 116
INDENT: Final = "  "

HELPERS: Final = """\
const rounded = Math.fround;
// A NaN as first argument stays.
const larger = (value, least) => (least > value ? least : value);
const smaller = (value, most) => (most < value ? most : value);"""

EQUALS: Final = {"==": "===", "!=": "!=="}

Records = Mapping[str, SizedRecord]
"""The sized records of an export by the name of the record."""


def js_functions(programs: tuple[Program, ...], records: Records) -> str:
    """The helpers, the constants, and each program as a function of its name; none before one that it asks."""
    constants = [f"const {name} = {float(value)!r};" for name, value in constants_of(programs).items()]
    return "\n".join([HELPERS, *constants, *("\n".join(_Printer(each, records).lines()) for each in programs)])


def js_values(record: SizedRecord, values: Mapping[str, Any]) -> dict[str, Any]:
    """The members of a record as JSON has them: numbers and flat lists; every float32 number exactly."""
    found = {}
    for name, member in record.members.items():
        array = np.asarray(values[name], dtype=np.float32 if member.kind is Kind.REAL else np.int32)
        if array.shape != record.shape(name):
            raise ValueError(f"{name} has the shape {array.shape}, but {record.shape(name)} is its room.")
        found[name] = array.ravel().tolist() if array.ndim else array.item()
    return found


def js_maker(name: str, record: SizedRecord) -> str:
    """A function `name` that makes a record of what `js_values` gives; without an argument all is 0."""
    rows = []
    for member, declared in record.members.items():
        if declared.axes:
            array = "Float32Array" if declared.kind is Kind.REAL else "Int32Array"
            rows.append(f"{member}: new {array}(values.{member} ?? {record.length(member)}),")
        else:
            rows.append(f"{member}: values.{member} ?? 0,")
    return "\n".join([f"const {name} = (values = {{}}) => ({{", *(INDENT + row for row in rows), "});"])


class _Printer:
    def __init__(self, program: Program, records: Records) -> None:
        self.program = program
        self.sized = {name: records[record.name] for name, record in program.records.items()}

    def lines(self) -> Iterator[str]:
        """The whole function."""
        program = self.program
        parameters = [each.name for each in program.parameters]
        yield from js_comment(program.note.split("\n\n")[0].replace("\n", " "))
        yield f"function {program.name}({', '.join(parameters)}) {{"
        yield from indented(self.inside(parameters))
        yield "}"

    def inside(self, parameters: list[str]) -> Iterator[str]:
        """What stands between the braces."""
        for each in self.program.parameters:
            if each.is_reading:
                yield f"{each.name} = rounded({each.name});"
        variables = [name for name in variables_of(self.program) if name not in parameters]
        if variables:
            yield from textwrap.wrap(f"let {', '.join(variables)};", WIDTH, subsequent_indent=2 * INDENT)
        yield from self.block(self.program.body)
        answers = ", ".join(each.name for each in self.program.answers)
        if answers:
            yield f"return {answers if len(self.program.answers) == 1 else f'[{answers}]'};"

    def block(self, body: tuple[Statement, ...]) -> Iterator[str]:
        """Statements one after the other."""
        for statement in body:
            if statement.comment:
                yield from js_comment(statement.comment)
            yield from self.statement(statement)

    def statement(self, statement: Statement) -> Iterator[str]:
        """The lines of one."""
        match statement:
            case Assign(target=target, value=value):
                yield f"{self.value(target)} = {self.bare(value)};"
            case Ask(targets=targets, program=asked, arguments=arguments):
                given = ", ".join(each if isinstance(each, str) else self.bare(each) for each in arguments)
                names = ", ".join(each.name for each in targets)
                into = "" if not targets else f"{names if len(targets) == 1 else f'[{names}]'} = "
                yield f"{into}{asked.name}({given});"
            case While(condition=condition, body=body):
                yield f"while ({self.bare(condition)}) {{"
                yield from indented(self.block(body))
                yield "}"
            case If(branches=branches, otherwise=otherwise):
                word = "if"
                for condition, body in branches:
                    yield f"{word} ({self.bare(condition)}) {{"
                    yield from indented(self.block(body))
                    word = "} else if"
                if otherwise:
                    yield "} else {"
                    yield from indented(self.block(otherwise))
                yield "}"

    def bare(self, value: Expression) -> str:
        """An expression without parentheses around the whole."""
        text = self.value(value)
        return text[1:-1] if isinstance(value, Binary | Compare | Logic) and text.startswith("(") else text

    def value(self, value: Expression) -> str:
        """An expression; what is no operand by itself stands in parentheses."""
        match value:
            case Number(value=number, kind=Kind.BOOL):
                return "true" if number else "false"
            case Number(value=number, kind=Kind.REAL, name=name):
                return name or f"{number:g}"
            case Number(value=number):
                return f"{int(number)}"
            case Name(name=name):
                return name
            case Item(record=record, member=member, indices=()):
                return f"{record}.{member}"
            case Item(record=record, member=member):
                return f"{record}.{member}[{self.index(value)}]"
            case Binary(sign=sign, left=left, right=right, kind=kind):
                if kind is Kind.REAL:
                    return f"rounded({self.value(left)} {sign} {self.value(right)})"
                return f"({self.value(left)} {sign} {self.value(right)})"
            case Extreme(is_larger=is_larger, left=left, right=right):
                return f"{'larger' if is_larger else 'smaller'}({self.bare(left)}, {self.bare(right)})"
            case Convert(value=inner, kind=kind):
                return self.value(inner) if kind is Kind.REAL else f"Math.trunc({self.bare(inner)})"
            case Compare(sign=sign, left=left, right=right):
                return f"({self.value(left)} {EQUALS.get(sign, sign)} {self.value(right)})"
            case Logic(is_all=is_all, values=values):
                return f"({(' && ' if is_all else ' || ').join(self.value(each) for each in values)})"
            case Not(value=inner):
                return f"!{self.value(inner)}"
            case Room():
                raise TypeError("the length of an axis is known once the program is folded")

    def index(self, item: Item) -> str:
        """The place in a flat array."""
        shape = self.sized[item.record].shape(item.member)
        text = self.value(item.indices[0])
        for length, each in zip(shape[1:], item.indices[1:], strict=True):
            text = f"({text} * {length} + {self.value(each)})"
        return text[1:-1] if text.startswith("(") else text


def indented(lines: Iterator[str]) -> Iterator[str]:
    """The lines of a block, one step in."""
    return (INDENT + line for line in lines)


def js_comment(text: str) -> list[str]:
    """The text as a comment."""
    return textwrap.wrap(text, WIDTH, initial_indent="// ", subsequent_indent="// ")
