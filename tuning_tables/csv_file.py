"""A table as CSV (RFC 4180), for spreadsheets and for controllers that read nothing else. Export only.

    record,key,value0,value1,value2,value3
    text,format,retarder-table,,,
    text,exported_by,retarder-synth 0.1.0,,,
    number,valid.s_m,0.0,37.45,,
    number,stages.1.lower,0.5,0.25,0.0,0.0
    number,passages.0.switching_m_s.1,4.5,6.25,inf,inf

A rectangle under one header line. `record` tells what a row holds: `text` or `number`, with the dotted key of the JSON
table and its value or values. What is null has no row; a switching speed that is null is -inf (never lower so far) or
inf (never raise so far). The nodes of an aim table have a row each, numbered from 0, under a row of `names`:

    names,node,cars,free_distance_m,resistance_n_per_kn,exit_speed_m_s,p_overspeed,...
    node,0,1,20.0,,1.4,0.099,...

A cell of a node is empty where there is no number. Numbers have the shortest form that reads back exactly. The checksum
is that of the JSON table.
"""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Sequence

from tuning_tables.aim.aim_table import AimTable
from tuning_tables.aim.node_rows import node_rows
from tuning_tables.atomic_file import write_atomically
from tuning_tables.canonical import CHECKSUM_KEY
from tuning_tables.declared.key_rows import key_rows, text_row
from tuning_tables.document import HEAD, to_document
from tuning_tables.table_kinds import AnyTable


def to_csv(table: AnyTable) -> bytes:
    """A table as CSV (RFC 4180), for spreadsheets and for controllers that read nothing else.

    Parameters
    ----------
    table
        A table of any kind.

    Returns
    -------
    bytes
        UTF-8 with CR LF line ends; equal tables give equal bytes.

    Raises
    ------
    InvalidTable
        A text that a spreadsheet would take for a formula and compute.

    Examples
    --------
    With `table` from the example of `ControllerTable`:

    >>> from tuning_tables import to_csv
    >>> to_csv(table).decode().splitlines()[5]
    'text,id,by-hand,,,'
    """
    document = to_document(table)
    told = {key: str(document[key]) for key in (*HEAD, CHECKSUM_KEY)}
    rows = [["number", key, told[key]] if key == "version" else text_row(key, told[key]) for key in HEAD]
    rows += key_rows(table, "")
    if isinstance(table, AimTable):
        rows += node_rows(table)
    return _rectangle([*rows, text_row(CHECKSUM_KEY, told[CHECKSUM_KEY])])


def write_csv(table: AnyTable, path: str | os.PathLike[str]) -> None:
    """Write `to_csv` of a table to a file, complete or not at all.

    Parameters
    ----------
    table
        A table of any kind.
    path
        The file; one that is there is replaced.

    Raises
    ------
    InvalidTable
        As `to_csv`.
    OSError
        The disk refuses it.

    Examples
    --------
    With `table` from the example of `ControllerTable`:

    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from tuning_tables import write_csv
    >>> with TemporaryDirectory() as folder:
    ...     write_csv(table, Path(folder, "table.csv"))
    """
    write_atomically(path, to_csv(table))


def _rectangle(rows: Sequence[Sequence[str]]) -> bytes:
    """The text of `rows`, each of a record, a key and values, under one header; UTF-8, CR LF line ends."""
    width = max(len(row) for row in rows)
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow(["record", "key", *(f"value{index}" for index in range(width - 2))])
    writer.writerows([*row, *[""] * (width - len(row))] for row in rows)
    return text.getvalue().encode("utf-8")
