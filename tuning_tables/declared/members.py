"""The members that a dataclass declares, read from its annotations."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass, fields, is_dataclass
from functools import cache
from types import MappingProxyType, NoneType
from typing import Annotated, Any, TypeAlias, cast, get_args, get_origin, get_type_hints

from tuning_tables.declared.leaf import Leaf
from tuning_tables.errors import InvalidTable
from tuning_tables.requirement import require_kind, require_tuple


@dataclass(frozen=True)
class Several:
    """Marks a tuple of sections: they lie along `axis`, from `fewest` to `most` of them."""

    meaning: str
    axis: str
    fewest: int
    most: int


@dataclass(frozen=True)
class LeafMember:
    """A member that is a leaf; `is_optional`: or None."""

    leaf: Leaf
    is_optional: bool


@dataclass(frozen=True)
class SectionMember:
    """A member that is a declared dataclass; `is_optional`: or None."""

    section: type
    is_optional: bool

    @property
    def meaning(self) -> str:
        """What the section is: the first sentence of its docstring."""
        return (self.section.__doc__ or "").strip().splitlines()[0]


@dataclass(frozen=True)
class SectionsMember:
    """A member that is a tuple of declared dataclasses."""

    section: type
    several: Several


DeclaredMember: TypeAlias = LeafMember | SectionMember | SectionsMember


def members_of(declared: type[Any]) -> Mapping[str, DeclaredMember]:
    """The members that the dataclass `declared` declares, in their order, without what it derives from them.

    Raises `TypeError` for a member whose type declares nothing.
    """
    return _members_of(cast(Hashable, declared))


@cache
def _members_of(declared: Hashable) -> Mapping[str, DeclaredMember]:
    hints = get_type_hints(declared, include_extras=True)
    return MappingProxyType({each.name: _member(hints[each.name], each.name) for each in _given(declared)})


def require_declared(value: Any, key: str = "") -> None:
    """Every member of `value`, a declared dataclass that stands at `key`, is what it declares, or `InvalidTable`."""
    for name, member in members_of(type(value)).items():
        found, at = getattr(value, name), f"{key}.{name}" if key else name
        if found is None and not isinstance(member, SectionsMember) and member.is_optional:
            continue
        match member:
            case LeafMember():
                member.leaf.check(found, at)
            case SectionMember():
                require_kind(found, at, member.section)
            case SectionsMember():
                _require_sections(found, at, member)


def _require_sections(found: Any, key: str, member: SectionsMember) -> None:
    require_tuple(found, key)
    several = member.several
    if not several.fewest <= len(found) <= several.most:
        raise InvalidTable(f"{key} has {len(found)} entries, but {several.fewest} to {several.most} are allowed.")
    for index, each in enumerate(found):
        require_kind(each, f"{key}[{index}]", member.section)


def _given(declared: Any) -> list[Any]:
    """The fields that a caller gives."""
    return [each for each in fields(declared) if each.init]


def _member(hint: Any, name: str) -> DeclaredMember:
    marks = get_args(hint)[1:] if get_origin(hint) is Annotated else ()
    kind = get_args(hint)[0] if marks else hint
    options = get_args(kind)
    is_optional = NoneType in options
    kinds = [each for each in (options if is_optional else (kind,)) if each is not NoneType]
    for mark in marks:
        if isinstance(mark, Several):
            return SectionsMember(options[0], mark)
        return LeafMember(mark, is_optional)
    if len(kinds) == 1 and is_dataclass(kinds[0]) and isinstance(kinds[0], type):
        return SectionMember(kinds[0], is_optional)
    raise TypeError(f"{name} declares neither a leaf nor a section.")
