"""A table for point sensors as CSV (RFC 4180), for spreadsheets and controllers that read nothing else. Export only.

    record,key,value0,value1,value2,value3
    text,format,retarder-table,,,
    number,passages.0.path_m,-4.0,,,
    switching,0.1,4.5,6.25,inf,inf

A rectangle under one header line, as of tables with lines (see `tuning_tables.csv_file`). A record `switching` has the
passage and the stage in force as its key, and as its values the K switching speeds of that row in m/s; -inf: never
lower so far, inf: never raise so far. The checksum is that of the JSON table.
"""

from __future__ import annotations

import os
from collections.abc import Iterator

from tuning_tables.atomic_file import write_atomically
from tuning_tables.csv_rows import property_rows, rectangle
from tuning_tables.passages.document import to_passage_document
from tuning_tables.passages.passage_table import PassageTable


def to_passage_csv(table: PassageTable) -> bytes:
    """The CSV text of `table`, UTF-8, CR LF line ends; equal tables give equal bytes.

    Raises `InvalidTable` for a text that a spreadsheet would take for a formula and compute.
    """
    return rectangle([*property_rows(to_passage_document(table), "", ("switching_m_s",)), *_switching_rows(table)])


def write_passage_csv(table: PassageTable, path: str | os.PathLike[str]) -> None:
    """Write `to_passage_csv(table)` to the file at `path`, complete or not at all; raises as that, and `OSError`."""
    write_atomically(path, to_passage_csv(table))


def _switching_rows(table: PassageTable) -> Iterator[list[str]]:
    for index, passage in enumerate(table.passages):
        for stage, row in enumerate(passage.switching_m_s):
            yield ["switching", f"{index}.{stage}", *(repr(float(speed)) for speed in row)]
