"""The language of the programs as frozen values: what `reading` gives and the printers take.

Expressions have a kind. A REAL operation is one rounding to binary32. There is one return, at the end.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from tuning_tables.language.records import Kind, Record


@dataclass(frozen=True)
class Number:
    """A number; `name` of a declared constant, "" for a small whole number that stands as it is."""

    value: float
    kind: Kind
    name: str = ""


@dataclass(frozen=True)
class Name:
    """A parameter or a variable of the program."""

    name: str
    kind: Kind


@dataclass(frozen=True)
class Item:
    """A member of a record, with its indices if it is an array."""

    record: str
    member: str
    indices: tuple[Expression, ...]
    kind: Kind


@dataclass(frozen=True)
class Room:
    """The length of an axis of a member."""

    record: str
    member: str
    axis: int
    kind: Kind = Kind.INT


@dataclass(frozen=True)
class Binary:
    """left `sign` right, one of + - * /."""

    sign: str
    left: Expression
    right: Expression
    kind: Kind


@dataclass(frozen=True)
class Extreme:
    """The smaller of two, or the larger: the second only where it is beyond the first, so a NaN as first one stays."""

    is_larger: bool
    left: Expression
    right: Expression
    kind: Kind


@dataclass(frozen=True)
class Convert:
    """A whole number as REAL, or a REAL that is whole as a whole number: exact, or of no meaning."""

    value: Expression
    kind: Kind


@dataclass(frozen=True)
class Compare:
    """left `sign` right, one of < <= > >= ==, !=."""

    sign: str
    left: Expression
    right: Expression
    kind: Kind = Kind.BOOL


@dataclass(frozen=True)
class Logic:
    """All of the values, or any; both sides may be evaluated whatever the first is."""

    is_all: bool
    values: tuple[Expression, ...]
    kind: Kind = Kind.BOOL


@dataclass(frozen=True)
class Not:
    """The opposite."""

    value: Expression
    kind: Kind = Kind.BOOL


Expression: TypeAlias = Number | Name | Item | Room | Binary | Extreme | Convert | Compare | Logic | Not


@dataclass(frozen=True)
class Assign:
    """target = value; `comment`: what stands above it in the source."""

    target: Name | Item
    value: Expression
    comment: str = ""


@dataclass(frozen=True)
class Ask:
    """targets = program(arguments): another program is run; `records` are handed over by their names."""

    targets: tuple[Name, ...]
    program: Program
    arguments: tuple[Expression | str, ...]
    comment: str = ""


@dataclass(frozen=True)
class If:
    """The first branch whose condition holds, or `otherwise`."""

    branches: tuple[tuple[Expression, tuple[Statement, ...]], ...]
    otherwise: tuple[Statement, ...]
    comment: str = ""


@dataclass(frozen=True)
class While:
    """The body as long as the condition holds."""

    condition: Expression
    body: tuple[Statement, ...]
    comment: str = ""


Statement: TypeAlias = Assign | Ask | If | While


@dataclass(frozen=True)
class Parameter:
    """A parameter: a number of a kind, or a record."""

    name: str
    kind: Kind | None
    record: Record | None = None
    meaning: str = ""
    is_reading: bool = False


@dataclass(frozen=True)
class Program:
    """A function: parameters, statements, what it returns (names, each a variable), and its docstring."""

    name: str
    note: str
    parameters: tuple[Parameter, ...]
    body: tuple[Statement, ...]
    answers: tuple[Name, ...]

    @property
    def records(self) -> dict[str, Record]:
        """Its records by the names of the parameters."""
        return {each.name: each.record for each in self.parameters if each.record is not None}
