"""The members that a dataclass declares, read from its annotations; what stands at a key without further keys
below it (a text, a number, or numbers in rows); and where in a JSON document it stands, for the sentence that
refuses it.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from functools import cache
from types import MappingProxyType, NoneType
from typing import Annotated, Any, NoReturn, Protocol, TypeAlias, cast, get_args, get_origin, get_type_hints

from tuning_tables.errors import DamagedTable, InvalidTable, excerpt, require_kind, require_tuple


@dataclass(frozen=True)
class Place:
    """The value at `path` (dotted, "" for the document) of the file `source`."""

    source: str
    path: str = ""

    def key(self, name: str) -> Place:
        """The member `name` of the object here."""
        return Place(self.source, f"{self.path}.{name}" if self.path else name)

    def item(self, index: int) -> Place:
        """The entry `index` of the array here."""
        return Place(self.source, f"{self.path}[{index}]")

    def refuse(self, value: object, wanted: str) -> NoReturn:
        """Raise `DamagedTable`: `value` stands here, but it must be `wanted`."""
        named = self.path or "the document"
        raise DamagedTable(f"{self.source}: {named} is {excerpt(repr(value))}, but it must be {wanted}.")

    def members(self, value: object, keys: Sequence[str]) -> dict[str, object]:
        """`value`, an object with exactly these keys; raises `DamagedTable`."""
        if not isinstance(value, dict):
            self.refuse(value, "an object")
        for key in keys:
            if key not in value:
                raise DamagedTable(f"{self.source}: {self.key(key).path} is missing; export the table again.")
        for key in value:
            if key not in keys:
                named, found = self.path or "the document", excerpt(repr(key))
                raise DamagedTable(
                    f"{self.source}: {named} has the unknown key {found}; allowed are {', '.join(keys)}."
                )
        return value

    def array(self, value: object) -> list[object]:
        """`value`, an array; raises `DamagedTable`."""
        if not isinstance(value, list):
            self.refuse(value, "an array")
        return value


Json = dict[str, Any]


class Leaf(Protocol):
    """What stands at a key without further keys below it.

    `dtype` and `axes` tell how a book holds it: a numpy type, "S" for text, and the axes beside those of its section.
    """

    @property
    def meaning(self) -> str:
        """What it is, without its unit, which its name tells."""
        ...

    @property
    def unit(self) -> str:
        """Its unit where its name does not tell it, else ""."""
        ...

    @property
    def allowed(self) -> str:
        """Its limits in words."""
        ...

    @property
    def axes(self) -> tuple[str, ...] | None:
        """The axes of its numbers; None where they are those of the whole table, so that no book holds it."""
        ...

    @property
    def dtype(self) -> str:
        """Its type in a book."""
        ...

    def check(self, value: Any, key: str) -> None:
        """Raise `InvalidTable` unless `value`, which stands at `key`, is allowed."""
        ...

    def written(self, value: Any) -> object:
        """`value` as JSON holds it."""
        ...

    def read(self, value: object, place: Place) -> Any:
        """What the JSON `value` at `place` is; raises `DamagedTable` for another type."""
        ...

    def schema(self) -> Json:
        """Its JSON Schema."""
        ...

    def cells(self, value: Any) -> Any:
        """`value` as a book holds it: a number, a text, or numbers in rows."""
        ...

    def of_cells(self, cells: Any) -> Any:
        """The value in the cells of a book, less what fills them up; raises `InvalidTable`."""
        ...


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
