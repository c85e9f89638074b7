"""Walks over programs: what they read, assign, change and ask; where elements stand in arrays of one axis, and
which rows a loop asks for again and again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import takewhile
from typing import NamedTuple

from tuning_tables.language.records import Kind
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
    Statement,
    While,
)


def names_read(statement: Statement) -> Iterator[str]:
    """The variables and parameters that a statement reads, with those of the statements in it."""
    match statement:
        case Assign(target=target, value=value):
            yield from names_in(value)
            if isinstance(target, Item):
                yield from names_in(target)
        case Ask(arguments=arguments):
            for each in arguments:
                yield from [] if isinstance(each, str) else names_in(each)
        case While(condition=condition, body=body):
            yield from names_in(condition)
            for inner in body:
                yield from names_read(inner)
        case If(branches=branches, otherwise=otherwise):
            for condition, body in branches:
                yield from names_in(condition)
                for inner in body:
                    yield from names_read(inner)
            for inner in otherwise:
                yield from names_read(inner)


def looked_at(program: Program) -> set[str]:
    """The variables and parameters that a program reads or answers."""
    read = {name for statement in program.body for name in names_read(statement)}
    return read | {each.name for each in program.answers}


def names_in(value: Expression) -> Iterator[str]:
    """The variables and parameters of an expression."""
    match value:
        case Name(name=name):
            yield name
        case Item(indices=indices):
            for each in indices:
                yield from names_in(each)
        case Binary() | Extreme() | Compare():
            yield from names_in(value.left)
            yield from names_in(value.right)
        case Logic(values=values):
            for each in values:
                yield from names_in(each)
        case Not(value=inner) | Convert(value=inner):
            yield from names_in(inner)


def states_changed(program: Program) -> set[str]:
    """The records, by their parameters, of which the program changes a member."""
    found: set[str] = set()

    def look(body: tuple[Statement, ...]) -> None:
        for statement in body:
            match statement:
                case Assign(target=Item(record=record)):
                    found.add(record)
                case Ask(program=asked, arguments=arguments):
                    inner = states_changed(asked)
                    pairs = zip(asked.parameters, arguments, strict=True)
                    found.update(str(given) for each, given in pairs if each.name in inner)
                case If(branches=branches, otherwise=otherwise):
                    for _, each in branches:
                        look(each)
                    look(otherwise)
                case While(body=inner_body):
                    look(inner_body)

    look(program.body)
    return found


def constants_of(programs: tuple[Program, ...]) -> Mapping[str, float]:
    """The named REAL constants of programs, and of those that they ask, by their names."""
    found: dict[str, float] = {}
    for program in programs:
        for each in expressions_in(program.body):
            if isinstance(each, Number) and each.name:
                found[each.name] = each.value
        asked = tuple(each.program for each in statements_in(program.body) if isinstance(each, Ask))
        found |= constants_of(asked)
    return found


def targets_in(body: tuple[Statement, ...]) -> Iterator[str]:
    """The variables that statements assign, as often as they do."""
    for statement in statements_in(body):
        match statement:
            case Assign(target=Name(name=name)):
                yield name
            case Ask(targets=targets):
                yield from (each.name for each in targets)


def variables_of(program: Program) -> dict[str, Kind]:
    """The variables of a program, with their kinds."""
    found: dict[str, Kind] = {}
    for statement in statements_in(program.body):
        match statement:
            case Assign(target=Name(name=name, kind=kind)):
                found[name] = kind
            case Ask(targets=targets):
                found |= {each.name: each.kind for each in targets}
    return found


def statements_in(body: tuple[Statement, ...]) -> Iterator[Statement]:
    """All statements, with those in them."""
    for statement in body:
        yield statement
        match statement:
            case If(branches=branches, otherwise=otherwise):
                for _, each in branches:
                    yield from statements_in(each)
                yield from statements_in(otherwise)
            case While(body=inner):
                yield from statements_in(inner)


def expressions_in(body: tuple[Statement, ...]) -> Iterator[Expression]:
    """All expressions of all statements, with those in them."""
    for statement in statements_in(body):
        match statement:
            case Assign(target=target, value=value):
                yield from parts_of(target)
                yield from parts_of(value)
            case Ask(arguments=arguments):
                for each in arguments:
                    yield from [] if isinstance(each, str) else parts_of(each)
            case If(branches=branches):
                for condition, _ in branches:
                    yield from parts_of(condition)
            case While(condition=condition):
                yield from parts_of(condition)


def parts_of(value: Expression) -> Iterator[Expression]:
    """An expression with all that is in it."""
    yield value
    match value:
        case Binary() | Extreme() | Compare():
            yield from parts_of(value.left)
            yield from parts_of(value.right)
        case Logic(values=values):
            for each in values:
                yield from parts_of(each)
        case Not(value=inner) | Convert(value=inner):
            yield from parts_of(inner)
        case Item(indices=indices):
            for each in indices:
                yield from parts_of(each)


class Row(NamedTuple):
    """A variable that holds where a row of an array begins, and the variables that this is calculated from."""

    name: str
    names: frozenset[str]


class ArrayPlaces:
    """Places of elements of a program, as text.

    `atom`: an operand as text; `shape`: the lengths of the axes of an element's array.
    """

    def __init__(self, atom: Callable[[Expression], str], shape: Callable[[Item], tuple[int, ...]]) -> None:
        self.atom = atom
        self.shape = shape

    def row(self, item: Item) -> str:
        """Where the row of an element begins, of which the last index tells the place."""
        text = "0"
        for length, each in zip(self.shape(item)[1:], item.indices[:-1], strict=True):
            text = sum_of(text, self.atom(each))
            if text.isdigit():
                text = f"{int(text) * length}"
            elif length > 1:
                text = f"{f'({text})' if ' + ' in text and not text.endswith(')') else text} * {length}"
        return text

    def rows_in(self, body: tuple[Statement, ...]) -> dict[str, frozenset[str]]:
        """The beginnings of rows that must be calculated, each with its variables."""
        items = [each for each in expressions_in(body) if isinstance(each, Item) and len(each.indices) > 1]
        return {
            text: frozenset(name for index in each.indices[:-1] for name in names_in(index))
            for each in items
            if " " in (text := self.row(each))
        }

    def asked_again(self, body: tuple[Statement, ...]) -> dict[str, frozenset[str]]:
        """The rows of the first statement that a loop needs before any of their variables changes."""
        return {
            text: names
            for text, names in self.rows_in(body[:1]).items()
            if not isinstance(body[0], If) and any(text in self.rows_in((each,)) for each in loops_before(body, names))
        }


def loops_before(body: tuple[Statement, ...], names: frozenset[str]) -> list[While]:
    """The loops among the statements up to the first that assigns one of the variables `names`."""
    same = takewhile(lambda each: not names & {*targets_in((each,))}, body)
    return [each for each in same if isinstance(each, While)]


def sum_of(one: str, other: str) -> str:
    """The sum of two, without a 0."""
    return other if one == "0" else one if other == "0" else f"{one} + {other}"
