"""The head of a JSON document: which format and version it claims to be, and whether its checksum is right."""

from __future__ import annotations

from tuning_tables.canonical import document_checksum
from tuning_tables.errors import DamagedTable, NewerVersion, OlderVersion, UnknownFormat


def require_format(document: object, source: str, wanted: str, noun: str) -> dict[str, object]:
    """The document, now known to be an object of the format `wanted`; `noun` is what to give instead of another."""
    if not isinstance(document, dict) or document.get("format") != wanted:
        found = document.get("format") if isinstance(document, dict) else type(document).__name__
        raise UnknownFormat(f'{source}: format is {found!r:.60}, but it must be "{wanted}"; give {noun}.')
    return document


def require_version(members: dict[str, object], source: str, oldest: int, newest: int) -> int:
    """The version of the document, from `oldest` to `newest`; `NewerVersion`, `OlderVersion` or `DamagedTable`."""
    version = members.get("version")
    several = newest > oldest
    if not isinstance(version, int) or isinstance(version, bool):
        wanted = f"a whole number from {oldest} to {newest}" if several else f"the whole number {newest}"
        raise DamagedTable(f"{source}: version is {version!r:.60}, but it must be {wanted}.")
    known = f"this reader knows only {f'{oldest} to ' if several else ''}{newest}"
    if version > newest:
        raise NewerVersion(f"{source}: version is {version}, {known}; update retarder-synth.")
    if version < oldest:
        raise OlderVersion(f"{source}: version is {version}, {known}; export it again.")
    return version


def require_checksum(members: dict[str, object], stored: str, source: str) -> None:
    """`stored` is the checksum of `members`; raises `DamagedTable`."""
    try:
        computed = document_checksum(members)
    except ValueError as fault:
        raise DamagedTable(f"{source}: the content has no checksum, for {fault}") from fault
    if stored != computed:
        raise DamagedTable(
            f"{source}: crc32 is {stored!r:.60}, but the content gives {computed!r}: "
            "it was changed after the export; export the table again."
        )
