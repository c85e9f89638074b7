"""What a controller holds, declared once: from a member follow its place in numpy, C99 and Structured Text.

A table is a `NamedTuple` whose members are annotated with `Member`: Python and numba read it as it is. A state is an
array of float32 whose places have names, so that a simulation holds one for each of many cuts.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from math import prod
from typing import Final, get_args, get_type_hints

from tuning_tables.units import ending_of

WORDS: Final[Mapping[str, str]] = {"s_m": "Path_m", "v_m_s": "Speed_m_s", "s": "Path", "v": "Speed"}
"""Letters of the mathematics in Structured Text, where one letter is no name."""


class Kind(Enum):
    """What a number is: its type in C99, in Structured Text, and in numpy."""

    REAL = ("float", "REAL", "f4")
    INT = ("int32_t", "INT", "i4")
    BOOL = ("int", "BOOL", "i4")

    @property
    def c(self) -> str:
        """Its type in C99."""
        return self.value[0]

    @property
    def st(self) -> str:
        """Its type in Structured Text."""
        return self.value[1]

    @property
    def numpy(self) -> str:
        """Its type in numpy, without the byte order."""
        return self.value[2]


@dataclass(frozen=True)
class Member:
    """A member of a record: its kind, what it means (with its unit), and what its axes count.

    `axes`: names of sizes, such as "stages", or whole numbers. `part`: the size without which an export has no such
    member, "" for one that every export has. `is_reading`: a parameter that Python may give in any width.
    """

    kind: Kind
    meaning: str
    axes: tuple[str | int, ...] = ()
    part: str = ""
    is_reading: bool = False


def real(meaning: str, *axes: str | int, part: str = "") -> Member:
    """A member that is a REAL, or an array of them."""
    return Member(Kind.REAL, meaning, axes, part)


def reading(meaning: str) -> Member:
    """A parameter that is a REAL in controllers, and in Python a number of any width that a program rounds."""
    return Member(Kind.REAL, meaning, is_reading=True)


def whole(meaning: str, *axes: str | int, part: str = "") -> Member:
    """A member that is a whole number of 16 bits, or an array of them."""
    return Member(Kind.INT, meaning, axes, part)


def flag(meaning: str) -> Member:
    """A parameter that is so or not."""
    return Member(Kind.BOOL, meaning)


@dataclass(frozen=True)
class Record:
    """A record: its name in snake case, what it is, and its members in their order.

    `is_state`: the programs change it, and Python holds it as an array of float32 with the places of its members.
    """

    name: str
    meaning: str
    members: Mapping[str, Member]
    is_state: bool = False

    def place(self, member: str) -> int:
        """The place of a member of a state."""
        return list(self.members).index(member)

    def sized(self, room: Mapping[str, int]) -> SizedRecord:
        """The record with this room: how long each axis is; 0 for a part that is not there."""
        return SizedRecord(self, dict(room))


@dataclass(frozen=True)
class SizedRecord:
    """A record of one export, with the length of every axis."""

    record: Record
    room: Mapping[str, int]

    @property
    def members(self) -> Mapping[str, Member]:
        """The members that this export has."""
        return {name: each for name, each in self.record.members.items() if not each.part or self.room[each.part]}

    def shape(self, member: str) -> tuple[int, ...]:
        """The lengths of the axes of a member, () for a number."""
        axes = self.record.members[member].axes
        return tuple(axis if isinstance(axis, int) else self.room[axis] for axis in axes)

    def length(self, member: str) -> int:
        """How many numbers the member has."""
        return prod(self.shape(member))

    def words(self) -> int:
        """How many words of 32 bits the record has."""
        return sum(self.length(name) for name in self.members)


def record_of(declared: type) -> Record:
    """The record that a `NamedTuple` declares: the members that are annotated with `Member`, and its docstring.

    Its name is that of the class in snake case.
    """
    hints = get_type_hints(declared, include_extras=True)
    members = {}
    for member, hint in hints.items():
        found = [each for each in get_args(hint) if isinstance(each, Member)]
        if len(found) != 1:
            raise ValueError(f"{declared.__name__}.{member} is not declared as a Member.")
        members[member] = found[0]
    name = "".join(f"_{each.lower()}" if each.isupper() else each for each in declared.__name__).strip("_")
    return Record(name, (declared.__doc__ or "").strip().splitlines()[0], members)


def st_name(name: str) -> str:
    """A name in Structured Text: `path_min_m` is `PathMin_m`; letters of the mathematics are words."""
    if name in WORDS:
        return WORDS[name]
    unit = ending_of(name)
    stem = name.removesuffix(f"_{unit}") if unit else name
    words = "".join(word[:1].upper() + word[1:] for word in stem.split("_"))
    return f"{words}_{unit}" if unit else words
