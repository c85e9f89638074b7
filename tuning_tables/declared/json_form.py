"""A declared value as dicts, lists, numbers and strings, and back."""

from __future__ import annotations

from typing import Any, TypeVar

from tuning_tables.declared.members import DeclaredMember, LeafMember, SectionMember, members_of
from tuning_tables.declared.place import Place

_T = TypeVar("_T")


def written(value: Any) -> dict[str, object]:
    """The object of `value`, whose class declares its members: its keys are their names, in their order."""
    return {name: _written(getattr(value, name), member) for name, member in members_of(type(value)).items()}


def read(declared: type[_T], value: object, place: Place) -> _T:
    """What the JSON object `value` at `place` is; it must have exactly the keys that `declared` declares.

    Raises `DamagedTable` for other keys and types, `InvalidTable` for values that `declared` refuses.
    """
    members = members_of(declared)
    found = place.members(value, tuple(members))
    return declared(**{name: _read(member, found[name], place.key(name)) for name, member in members.items()})


def _written(value: Any, member: DeclaredMember) -> object:
    if value is None:
        return None
    match member:
        case LeafMember():
            return member.leaf.written(value)
        case SectionMember():
            return written(value)
        case _:
            return [written(each) for each in value]


def _read(member: DeclaredMember, value: object, place: Place) -> Any:
    match member:
        case LeafMember():
            return None if value is None and member.is_optional else member.leaf.read(value, place)
        case SectionMember():
            return None if value is None and member.is_optional else read(member.section, value, place)
        case _:
            items = enumerate(place.array(value))
            return tuple(read(member.section, each, place.item(index)) for index, each in items)
