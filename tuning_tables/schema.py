"""The JSON Schema (draft 2020-12) of a table, for editors and for readers in other languages.

A schema states keys, types and ranges. What it cannot state, the reader checks beyond it: the checksum, the order of
stages, lines, passages and axes, that numbers belong together, what float32 can hold, and that no key is given twice.
"""

from __future__ import annotations

from tuning_tables.canonical import CHECKSUM_KEY
from tuning_tables.declared.json_schema import DIALECT, object_of, schema_of
from tuning_tables.declared.leaf import Json
from tuning_tables.document import EXPORTED_BY, FORMAT, VERSION
from tuning_tables.table_kinds import KINDS


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
