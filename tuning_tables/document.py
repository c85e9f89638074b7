"""A table of any kind as a JSON document (dicts, lists, numbers, strings), and back, without the text around it; and
the JSON Schema (draft 2020-12) of a table, for editors and for readers in other languages.

A document has a head, the members that the class of its kind declares, and a checksum:

    {"format": "retarder-table", "version": 1, "kind": "lines", "exported_by": "retarder-synth 0.1.0", ...,
     "crc32": "0f1e2d3c"}

A schema states keys, types and ranges. What it cannot state, the reader checks beyond it: the checksum, the order of
stages, lines, passages and axes, that numbers belong together, what float32 can hold, and that no key is given twice.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Final, TypeAlias, TypeVar

from tuning_tables.aim.aim_tables import AimTable
from tuning_tables.declared.members import DeclaredMember, Json, LeafMember, Place, SectionMember, members_of
from tuning_tables.declared.texts import Text
from tuning_tables.errors import DamagedTable, InvalidTable, NewerVersion, OtherKind, UnknownFormat, excerpt
from tuning_tables.export_names import exporter
from tuning_tables.json_text import CHECKSUM_KEY, document_checksum
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.table import ControllerTable

StageTable: TypeAlias = ControllerTable | PassageTable
"""A table from which a controller takes stages."""
AnyTable: TypeAlias = StageTable | AimTable

KINDS: Final[Mapping[str, type[AnyTable]]] = MappingProxyType(
    {"lines": ControllerTable, "passages": PassageTable, "aim": AimTable}
)
"""By the word at "kind"."""
MEANINGS: Final[Mapping[str, str]] = MappingProxyType({
    "lines": "switching lines over the path",
    "passages": "switching speeds at passages over point sensors",
    "aim": "exit speeds by cars and free distance",
})  # fmt: skip
"""What a table of each kind has."""
BOOK_KINDS: Final = ("lines", "passages")
"""The kinds of which there are books."""


def kind_of(table: type[object]) -> str:
    """The word of a class of tables."""
    return next(kind for kind, each in KINDS.items() if each is table)


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


DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"


def schema_of(declared: type) -> Json:
    """An object with exactly the declared members, all of them required.

    A class may state more of them in `SCHEMA`, a schema that must hold, too.
    """
    whole = object_of({name: _schema(member) for name, member in members_of(declared).items()})
    further = getattr(declared, "SCHEMA", None)
    return whole if further is None else {**whole, "allOf": [further]}


def object_of(properties: Json) -> Json:
    """An object with exactly these members."""
    return {
        "type": "object",
        "properties": properties,
        "required": list(properties),
        "additionalProperties": False,
    }


def _schema(member: DeclaredMember) -> Any:
    match member:
        case LeafMember():
            return _or_null(member.leaf.schema(), member.is_optional)
        case SectionMember():
            return _or_null(schema_of(member.section), member.is_optional)
        case _:
            several = member.several
            items = schema_of(member.section)
            return {"type": "array", "items": items, "minItems": several.fewest, "maxItems": several.most}


def _or_null(schema: Json, is_optional: bool) -> Json:
    return {"anyOf": [{"type": "null"}, schema]} if is_optional else schema


FORMAT: Final = "retarder-table"
VERSION: Final = 1
HEAD: Final = ("format", "version", "kind", "exported_by")
EXPORTED_BY: Final = Text("program that wrote the file")
LONGEST_REASON: Final = 400


def to_document(table: AnyTable, exported_by: str = "") -> dict[str, object]:
    """The document of `table`, in the order in which it is to be read, its checksum last.

    `exported_by`: the program that writes it; this one unless given.

    Raises `InvalidTable` where a number is -0.0: RFC 8785 writes it as 0, so the checksum would not cover its sign.
    """
    head = dict(zip(HEAD, (FORMAT, VERSION, kind_of(type(table)), exported_by or exporter()), strict=True))
    document = {**head, **written(table)}
    return {**document, CHECKSUM_KEY: document_checksum(document)}


def from_document(document: object, source: str, kinds: tuple[type[_T], ...]) -> _T:
    """The table in `document`, as parsed from the file that `source` names in messages; its class is one of `kinds`.

    Raises `UnknownFormat` and `NewerVersion` for another format or version, `OtherKind` for a table of another kind,
    and `DamagedTable` for a wrong checksum, a missing or unknown key, a wrong type, and values that make no table.
    Checked in this order.
    """
    members = _of_format(document, source)
    table = _class_of(members, source)
    chosen = next((each for each in kinds if each is table), None)
    if chosen is None:
        raise OtherKind(
            f"{source}: its kind is {kind_of(table)} ({MEANINGS[kind_of(table)]}), but here a table is needed whose "
            f"kind is {' or '.join(map(kind_of, kinds))}."
        )
    _require_checksum(members, source)
    place = Place(source)
    try:
        EXPORTED_BY.check(members.get("exported_by"), "exported_by")
        return read(chosen, {key: value for key, value in members.items() if key not in (*HEAD, CHECKSUM_KEY)}, place)
    except InvalidTable as invalid:
        # The reason may quote a value, and a file may hold one of any length.
        raise DamagedTable(f"{source}: {excerpt(str(invalid), LONGEST_REASON)}") from invalid


def _of_format(document: object, source: str) -> dict[str, object]:
    """The document, now known to be an object of the format and version."""
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        found = document.get("format") if isinstance(document, dict) else type(document).__name__
        raise UnknownFormat(f'{source}: format is {found!r:.60}, but it must be "{FORMAT}"; give a controller table.')
    version = document.get("version")
    if isinstance(version, int) and version > VERSION:
        raise NewerVersion(
            f"{source}: version is {version!r:.60}, this reader knows only {VERSION}; update retarder-synth."
        )
    if version != VERSION or not isinstance(version, int) or isinstance(version, bool):
        raise DamagedTable(f"{source}: version is {version!r:.60}, but it must be the whole number {VERSION}.")
    return document


def _class_of(members: dict[str, object], source: str) -> type[AnyTable]:
    kind = members.get("kind")
    if not isinstance(kind, str) or kind not in KINDS:
        known = " or ".join(f'"{each}"' for each in KINDS)
        raise DamagedTable(f"{source}: kind is {kind!r:.60}, but it must be {known}; export the table again.")
    return KINDS[kind]


def _require_checksum(members: dict[str, object], source: str) -> None:
    stored = members.get(CHECKSUM_KEY)
    try:
        computed = document_checksum(members)
    except ValueError as fault:
        raise DamagedTable(f"{source}: the content has no checksum, for {fault}") from fault
    if stored != computed:
        raise DamagedTable(
            f"{source}: crc32 is {stored!r:.60}, but the content gives {computed!r}: "
            "it was changed after the export; export the table again."
        )


def table_schema(kind: str) -> Json:
    """The JSON Schema (draft 2020-12) of the tables of a kind.

    Parameters
    ----------
    kind
        "lines", "passages" or "aim".

    Returns
    -------
    dict
        A new schema.

    Raises
    ------
    KeyError
        There is no such kind.

    Examples
    --------
    >>> from tuning_tables import table_schema
    >>> table_schema("lines")["title"]
    'retarder-table 1, lines'
    """
    members = schema_of(KINDS[kind])
    const = {"format": FORMAT, "version": VERSION, "kind": kind}
    head = {**{key: {"const": value} for key, value in const.items()}, "exported_by": EXPORTED_BY.schema()}
    checksum = {CHECKSUM_KEY: {"type": "string", "pattern": "^[0-9a-f]{8}$"}}
    whole = object_of({**head, **members["properties"], **checksum})
    return {"$schema": DIALECT, "title": f"{FORMAT} {VERSION}, {kind}", **members, **whole}
