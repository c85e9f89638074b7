"""A table as CSV (RFC 4180), for spreadsheets and for controllers that read nothing else; and the one rule on texts
that a spreadsheet would compute. Export only.

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

A spreadsheet takes a cell that begins with one of `FORMULA_MARKS` for a formula, and a formula can run a program or
send what it finds to another machine. Names of cuts, cars and tables come from users and from logs. So in a sheet for
people such a text gets an apostrophe before it, which a spreadsheet shows as text. Files that programs read back keep
every text as it is (logs, events, sorting lists), or refuse such a text (`csv_rows`).
"""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, Final

import numpy as np

from tuning_tables.aim.aim_tables import AimTable
from tuning_tables.aim.nodes import FIGURES
from tuning_tables.declared.members import LeafMember, SectionMember, members_of
from tuning_tables.document import HEAD, AnyTable, to_document
from tuning_tables.errors import InvalidTable, excerpt
from tuning_tables.json_text import CHECKSUM_KEY
from tuning_tables.whole_file import write_atomically

FORMULA_MARKS: Final = ("=", "+", "-", "@", "\t", "\r", "\n")


def is_formula(text: str) -> bool:
    """Whether a spreadsheet may take `text` for a formula. A written number is none."""
    if not text.startswith(FORMULA_MARKS):
        return False
    try:
        float(text)
    except ValueError:
        return True
    return False


def sheet(head: Sequence[str], rows: Iterable[Sequence[object]]) -> bytes:
    """The rows under the names `head` as CSV of RFC 4180 in UTF-8; no cell is a formula, and numbers stay numbers."""
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerows([_shown(cell) for cell in row] for row in (head, *rows))
    return text.getvalue().encode()


def _shown(cell: object) -> object:
    return f"'{cell}" if isinstance(cell, str) and is_formula(cell) else cell


def key_rows(value: Any, key: str) -> Iterator[list[str]]:
    """A row for each text, number or row of numbers of the declared `value` found at `key`; none for what is None.

    Numbers at the nodes of a table have none: they lie along no axis of their own. Raises as `text_row`.
    """
    for name, member in members_of(type(value)).items():
        found, at = getattr(value, name), f"{key}.{name}" if key else name
        if found is None:
            continue
        match member:
            case LeafMember():
                leaf = member.leaf
                if leaf.dtype == "S":
                    yield text_row(at, str(leaf.written(found)))
                elif leaf.axes is not None:
                    yield from _number_rows(leaf.cells(found), at)
            case SectionMember():
                yield from key_rows(found, at)
            case _:
                for index, each in enumerate(found):
                    yield from key_rows(each, f"{at}.{index}")


def text_row(key: str, text: str) -> list[str]:
    """The row of a text; `InvalidTable` for one that a spreadsheet would take for a formula and compute."""
    if text.startswith(FORMULA_MARKS):
        raise InvalidTable(
            f"{key} is {excerpt(text)!r}, which a spreadsheet would compute; give it a name that does not begin "
            f"with {text[0]!r}, or export another form."
        )
    return ["text", key, text]


def _number_rows(cells: Any, key: str) -> Iterator[list[str]]:
    """One row of a number or a row of numbers, else a row for each of what it holds."""
    if not isinstance(cells, list | tuple):
        yield ["number", key, repr(cells)]
    elif isinstance(cells[0], list | tuple):
        for index, row in enumerate(cells):
            yield from _number_rows(row, f"{key}.{index}")
    else:
        yield ["number", key, *map(repr, cells)]


COLUMNS: Final = ("cars", "free_distance_m", "resistance_n_per_kn", "exit_speed_m_s", *FIGURES)


def node_rows(table: AimTable) -> Iterator[list[str]]:
    """A row of names, then a row a node, numbered from 0; a cell is empty where there is no number."""
    yield ["names", "node", *COLUMNS]
    axes, reported = table.axes, table.reported
    values = [table.exit_speed_m_s, *(getattr(reported, name) for name in FIGURES)]
    for number, place in enumerate(np.ndindex(axes.shape)):
        resistance = "" if axes.resistance_n_per_kn is None else repr(float(axes.resistance_n_per_kn[place[2]]))
        told = ["" if np.isnan(each[place]) else repr(float(each[place])) for each in values]
        distance = repr(float(axes.free_distance_m[place[1]]))
        yield ["node", str(number), str(int(axes.cars[place[0]])), distance, resistance, *told]


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
