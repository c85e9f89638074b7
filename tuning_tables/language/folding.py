"""A program as one export needs it: what it has no room for is left out, with all that only that was for.

A member that an export has not reads as 0, and is not written. Conditions that are then known go, branches that are
never taken go, and so do variables that nobody reads.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

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
from tuning_tables.language.walking import looked_at, names_read

Records = Mapping[str, SizedRecord]
"""The sized records of an export by the name of the record."""

COMPARED = {
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
    "==": lambda a, b: a == b,
    "!=": lambda a, b: a != b,
}
"""What a comparison of two numbers gives."""


def folded(program: Program, records: Records) -> Program:
    """The program for an export that has these records; a program that it asks takes only numbers that it reads."""
    folder = _Folder({name: records[each.name] for name, each in program.records.items()}, records)
    body = _used(folder.block(program.body), {answer.name for answer in program.answers})
    return replace(program, body=body)


class _Folder:
    def __init__(self, sized: Records, all_records: Records) -> None:
        self.sized = sized
        self.all_records = all_records

    def block(self, body: tuple[Statement, ...]) -> tuple[Statement, ...]:
        return tuple(each for statement in body for each in self.statement(statement))

    def statement(self, statement: Statement) -> Iterator[Statement]:
        match statement:
            case Assign(target=Item(record=record, member=member)) if member not in self.sized[record].members:
                return
            case Assign(target=Item() as target, value=value):
                indices = tuple(map(self.expression, target.indices))
                yield replace(statement, target=replace(target, indices=indices), value=self.expression(value))
            case Assign(value=value):
                yield replace(statement, value=self.expression(value))
            case Ask(program=program, arguments=arguments):
                asked = folded(program, self.all_records)
                read = {*asked.records, *looked_at(asked)}
                pairs = [pair for pair in zip(asked.parameters, arguments, strict=True) if pair[0].name in read]
                given = tuple(each if isinstance(each, str) else self.expression(each) for _, each in pairs)
                taken = tuple(each for each, _ in pairs)
                yield replace(statement, program=replace(asked, parameters=taken), arguments=given)
            case While(condition=condition, body=body):
                found = self.expression(condition)
                if found != FALSE:
                    yield replace(statement, condition=found, body=self.block(body))
            case If():
                yield from self.branches(statement)

    def branches(self, statement: If) -> Iterator[Statement]:
        kept: list[tuple[Expression, tuple[Statement, ...]]] = []
        otherwise = statement.otherwise
        for condition, body in statement.branches:
            found = self.expression(condition)
            if found == FALSE:
                continue
            if found == TRUE:
                otherwise = body
                break
            kept.append((found, self.block(body)))
        rest = self.block(otherwise)
        if kept:
            yield replace(statement, branches=tuple(kept), otherwise=rest)
        elif rest and statement.comment and isinstance(rest[0], Assign | Ask | If | While) and not rest[0].comment:
            yield replace(rest[0], comment=statement.comment)
            yield from rest[1:]
        else:
            yield from rest

    def expression(self, value: Expression) -> Expression:
        match value:
            case Item(record=record, member=member, indices=indices):
                if member not in self.sized[record].members:
                    return Number(0, value.kind)
                return replace(value, indices=tuple(map(self.expression, indices)))
            case Room(record=record, member=member, axis=axis):
                return Number(self.sized[record].shape(member)[axis], Kind.INT)
            case Binary() | Extreme():
                return replace(value, left=self.expression(value.left), right=self.expression(value.right))
            case Compare(sign=sign):
                left, right = self.expression(value.left), self.expression(value.right)
                if isinstance(left, Number) and isinstance(right, Number):
                    return TRUE if COMPARED[sign](left.value, right.value) else FALSE
                return replace(value, left=left, right=right)
            case Logic(is_all=is_all):
                known, open_ = (FALSE, TRUE) if is_all else (TRUE, FALSE)
                each = [found for found in map(self.expression, value.values) if found != open_]
                if known in each or not each:
                    return known if known in each else open_
                return each[0] if len(each) == 1 else replace(value, values=tuple(each))
            case Convert():
                return replace(value, value=self.expression(value.value))
            case Not():
                inner = self.expression(value.value)
                return FALSE if inner == TRUE else TRUE if inner == FALSE else Not(inner)
        return value


TRUE, FALSE = Number(1, Kind.BOOL), Number(0, Kind.BOOL)


def _used(body: tuple[Statement, ...], answers: set[str]) -> tuple[Statement, ...]:
    """Without assignments to variables that nobody reads, until all that is left is read."""
    while True:
        read = answers | {name for statement in body for name in names_read(statement)}
        kept = _kept(body, read)
        if kept == body:
            return body
        body = kept


def _kept(body: tuple[Statement, ...], read: set[str]) -> tuple[Statement, ...]:
    found: list[Statement] = []
    for statement in body:
        match statement:
            case Assign(target=Name(name=name)) if name not in read:
                continue
            case If(branches=branches, otherwise=otherwise):
                kept = tuple((condition, _kept(each, read)) for condition, each in branches)
                rest = _kept(otherwise, read)
                if rest or any(each for _, each in kept):
                    found.append(replace(statement, branches=kept, otherwise=rest))
            case While(body=inner):
                found.append(replace(statement, body=_kept(inner, read)))
            case _:
                found.append(statement)
    return tuple(found)
