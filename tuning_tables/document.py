"""A table of any kind as a JSON document (dicts, lists, numbers, strings), and back, without the text around it.

A document has a head, the members that the class of its kind declares, and a checksum:

    {"format": "retarder-table", "version": 1, "kind": "lines", "exported_by": "retarder-synth 0.1.0", ...,
     "crc32": "0f1e2d3c"}
"""

from __future__ import annotations

from typing import Final

from tuning_tables.canonical import CHECKSUM_KEY, document_checksum
from tuning_tables.declared.json_form import _T, read, written
from tuning_tables.declared.place import Place
from tuning_tables.declared.texts import Text
from tuning_tables.errors import DamagedTable, InvalidTable, NewerVersion, OtherKind, UnknownFormat
from tuning_tables.excerpt import excerpt
from tuning_tables.exporter import exporter
from tuning_tables.table_kinds import KINDS, MEANINGS, AnyTable, kind_of

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
