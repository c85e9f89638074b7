"""Whether two tables of one record differ in nothing but the members that are each one's own: it follows from them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tuning_tables.language.records import Kind, SizedRecord
from tuning_tables.language.tree import (
    Assign,
    Binary,
    Compare,
    Expression,
    Item,
    Logic,
    Name,
    Number,
    Parameter,
    Program,
    Statement,
    While,
)

SAME = Name("same", Kind.BOOL)
PLACES = tuple(Name(name, Kind.INT) for name in ("i", "j", "k"))


def alike_program(record: SizedRecord) -> Program:
    """The program `alike` (slower, faster): same."""
    body: list[Statement] = [Assign(SAME, Number(1, Kind.BOOL))]
    for name, member in record.members.items():
        if not member.is_own:
            body += _compared(record, name, ())
    parameters = tuple(Parameter(name, None, record.record) for name in ("slower", "faster"))
    note = "Whether the two differ in nothing but target and lines, so that what lies between them has a meaning."
    return Program("alike", note, parameters, tuple(body), (SAME,))


def _compared(record: SizedRecord, name: str, indices: tuple[Expression, ...]) -> Iterator[Statement]:
    """Compare a member, an axis after the other."""
    shape, kind = record.shape(name), record.record.members[name].kind
    if len(indices) == len(shape):
        slower, faster = (Item(side, name, indices, kind) for side in ("slower", "faster"))
        yield Assign(SAME, Logic(True, (SAME, Compare("==", slower, faster))))
        return
    place = PLACES[len(indices)]
    yield Assign(place, Number(0, Kind.INT))
    step = Assign(place, Binary("+", place, Number(1, Kind.INT), Kind.INT))
    more = Compare("<", place, Number(shape[len(indices)], Kind.INT))
    yield While(more, (*_compared(record, name, (*indices, place)), step))


def alike(one: Any, other: Any, own: frozenset[str]) -> bool:
    """The same in Python: whether two records, `NamedTuple`s, are equal but for the members `own`."""
    pairs = zip(one._fields, one, other, strict=True)
    return all(name in own or np.array_equal(a, b) for name, a, b in pairs)
