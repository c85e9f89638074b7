"""What an export in Structured Text declares, as frozen values: structures and function blocks.

Each form of the export (`.st`, PLCopen XML, TwinCAT, SCL) lays out these values; none reads a text again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Final, TypeAlias

from tuning_tables.language.records import Kind, SizedRecord, st_name

MARK: Final = "#"
"""Stands in statements before the name of each variable of the block, as SCL writes it; other forms leave it out."""


@dataclass(frozen=True)
class Declared:
    """The type of a variable that is a structure, or an instance of a block, of the export."""

    name: str


@dataclass(frozen=True)
class ArrayOf:
    """`length` numbers of a kind, from index 0."""

    kind: Kind
    length: int


VariableType: TypeAlias = Kind | Declared | ArrayOf


@dataclass(frozen=True)
class Variable:
    """A variable, a constant, or a member of a structure.

    `note`: what it means. `values`: its initial value as literals, those of an array one by one, none where it begins
    with 0; `row`: how many of them belong into one line, 0 for as many as fit.
    """

    name: str
    type: VariableType
    note: str = ""
    values: tuple[str, ...] = ()
    row: int = 0

    def __post_init__(self) -> None:
        length = self.type.length if isinstance(self.type, ArrayOf) else 1
        if self.values and len(self.values) != length:
            raise ValueError(f"{self.name} has {len(self.values)} values, but room for {length}")


@dataclass(frozen=True)
class Structure:
    """A type with members."""

    name: str
    note: str
    members: tuple[Variable, ...]

    @property
    def variables(self) -> tuple[Variable, ...]:
        """All that it declares."""
        return self.members


def st_structure(record: SizedRecord, name: str) -> Structure:
    """The declaration of a record."""
    members = []
    for member, declared in record.members.items():
        kind = ArrayOf(declared.kind, record.length(member)) if declared.axes else declared.kind
        members.append(Variable(st_name(member), kind, declared.meaning))
    return Structure(name, record.record.meaning, tuple(members))


@dataclass(frozen=True)
class Block:
    """A function block: its variables by section, and its statements, line by line, with `MARK` in them."""

    name: str
    note: str
    body: tuple[str, ...]
    inputs: tuple[Variable, ...] = ()
    in_outs: tuple[Variable, ...] = ()
    outputs: tuple[Variable, ...] = ()
    own: tuple[Variable, ...] = ()
    constants: tuple[Variable, ...] = ()

    def __post_init__(self) -> None:
        # Where capitals count for nothing.
        names = [each.name.upper() for each in self.variables]
        if len(set(names)) < len(names):
            raise ValueError(f"{self.name}: two names are one in Structured Text: {sorted(names)}")

    @property
    def variables(self) -> tuple[Variable, ...]:
        """All that it declares, in the order of the sections."""
        return (*self.inputs, *self.in_outs, *self.outputs, *self.own, *self.constants)


Unit: TypeAlias = Structure | Block


@dataclass(frozen=True)
class Part:
    """Units that belong together: `stem` names their file, `head` are the lines of its first comment.

    `is_test`: what may be left out once the self-test has run.
    """

    stem: str
    head: tuple[str, ...]
    units: tuple[Unit, ...]
    is_test: bool = False


Export: TypeAlias = tuple[Part, ...]
"""The parts of an export; no unit needs one that comes later."""


def local(name: str) -> str:
    """The name of a variable of the block, as it stands in statements."""
    return f"{MARK}{name}"


def plain(line: str) -> str:
    """A line of statements without marks."""
    return line.replace(MARK, "")


def units_of(export: Export) -> Iterator[Unit]:
    """All units, none before one that it needs."""
    for part in export:
        yield from part.units


def retold(unit: Unit, change: Callable[[str], str]) -> Unit:
    """The unit with `change` in each of its texts: names, types, notes, statements."""
    if isinstance(unit, Structure):
        return Structure(change(unit.name), change(unit.note), _retold(unit.members, change))
    return Block(
        change(unit.name),
        change(unit.note),
        tuple(map(change, unit.body)),
        *(_retold(each, change) for each in (unit.inputs, unit.in_outs, unit.outputs, unit.own, unit.constants)),
    )


def _retold(variables: tuple[Variable, ...], change: Callable[[str], str]) -> tuple[Variable, ...]:
    return tuple(
        replace(
            each,
            name=change(each.name),
            type=Declared(change(each.type.name)) if isinstance(each.type, Declared) else each.type,
            note=change(each.note),
        )
        for each in variables
    )
