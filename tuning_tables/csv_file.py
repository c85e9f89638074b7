"""A controller table as CSV (RFC 4180), for spreadsheets and for controllers that read nothing else. Export only.

    record,key,value0,value1,value2,value3
    text,format,retarder-table,,,
    number,valid.s_m,0.0,37.45,,
    number,stages.0.pressure_kpa,0.0,,,
    lower,1,0.5,0.25,0.0,0.0

A rectangle under one header line. `record` tells what a row holds: `text` or `number`, with the dotted key of the JSON
table and its value or values; `lower` or `upper`, with the stage k and the coefficients of its line in ascending
powers of the path. A line that a stage does not have, and any other null, has no row. Numbers have the shortest form
that reads back exactly. The checksum is that of the JSON table.
"""

from __future__ import annotations

import os
from collections.abc import Iterator

from tuning_tables.atomic_file import write_atomically
from tuning_tables.csv_rows import property_rows, rectangle
from tuning_tables.document import to_document
from tuning_tables.table import ControllerTable


def to_csv(table: ControllerTable) -> bytes:
    """The CSV text of `table`, UTF-8, CR LF line ends; equal tables give equal bytes.

    Raises `InvalidTable` for a text that a spreadsheet would take for a formula and compute.
    """
    return rectangle([*property_rows(to_document(table), "", ("lower", "upper")), *_line_rows(table)])


def write_csv(table: ControllerTable, path: str | os.PathLike[str]) -> None:
    """Write `to_csv(table)` to the file at `path`, complete or not at all; raises `OSError`, and as `to_csv`."""
    write_atomically(path, to_csv(table))


def _line_rows(table: ControllerTable) -> Iterator[list[str]]:
    for stage in table.stages:
        for name, line in (("lower", stage.lower), ("upper", stage.upper)):
            if line is not None:
                yield [name, str(stage.k), *(repr(float(coefficient)) for coefficient in line)]
