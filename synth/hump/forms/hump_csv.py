"""A hump as a table, a row an element, for spreadsheets: CSV with the keys of a hump file as columns."""

from __future__ import annotations

import csv
import io
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from plant_models.library.data_file import shown, shown_key
from plant_models.library.hump_cars import for_cars
from plant_models.library.hump_cells import ELEMENTS, PROFILE, Key, Schema
from plant_models.library.hump_entry import FORMAT, VERSION, HumpEntry, hump_at
from plant_models.library.hump_forms import short_text, text, texts, wholes
from plant_models.library.near_miss import near_miss
from plant_models.library.toml_lines import Place
from synth.frame.input_error import InputError
from synth.frame.settings.toml_text import value_text
from synth.frame.workbook import to_workbook
from synth.hump.forms.hump_tree import Tree, hump_tree
from synth.retarder.configuration.plant_fault import in_file

KIND: Final = "kind"
HUMP: Final = "hump"
OF_HUMP: Final[Mapping[str, Key]] = {"leads": Key("", wholes), "profile_from_crest": PROFILE}
HEAD: Final[Mapping[str, Key]] = {
    "title": Key("", text),
    "notes": Key("", texts),
    "for_cars": Key("", for_cars),
    **OF_HUMP,
}
"""Columns of the row of the kind `hump`; of these, keys of its table in a hump file."""

NUMBER: Final = re.compile(r"[-+]?\d+,\d+")
"""With the decimal comma of a spreadsheet."""


def keys_in(schema: Schema, prefix: str) -> Iterator[tuple[str, Key]]:
    """The dotted keys of a row."""
    for name, below in schema.items():
        if isinstance(below, Key):
            yield f"{prefix}{name}", below
        else:
            yield from keys_in(below, f"{prefix}{name}.")


COLUMNS: Final[Mapping[str, Key]] = {
    **HEAD,
    **{name: key for schema in ELEMENTS.values() for name, key in keys_in(schema, "")},
}
"""What each column but the first holds."""


def to_csv(hump: HumpEntry) -> str:
    """The table as CSV."""
    written = io.StringIO()
    csv.writer(written, lineterminator="\n").writerows([cell_text(cell) for cell in row] for row in to_rows(hump))
    return written.getvalue()


def to_xlsx(hump: HumpEntry) -> bytes:
    """The table as a workbook; numbers are numbers there, what a cell cannot hold is as in a hump file."""
    rows = [[c if isinstance(c, int | float | str | None) else cell_text(c) for c in row] for row in to_rows(hump)]
    return to_workbook({HUMP: rows})


def to_rows(hump: HumpEntry) -> list[list[Any]]:
    """The table with its head; only columns in which something stands."""
    tree = hump_tree(hump)
    head = {KIND: HUMP, **{name: (tree["hump"] if name in OF_HUMP else tree).get(name) for name in HEAD}}
    rows = [head, *({KIND: kind, **flat(row, "")} for kind in ELEMENTS for row in tree["hump"].get(kind, []))]
    columns = [KIND, *(name for name in COLUMNS if any(row.get(name) is not None for row in rows))]
    return [columns, *([row.get(name) for name in columns] for row in rows)]


def flat(row: Tree, prefix: str) -> Tree:
    """Nested tables as one with dotted keys."""
    found: Tree = {}
    for key, value in row.items():
        found |= flat(value, f"{prefix}{key}.") if isinstance(value, dict) else {f"{prefix}{key}": value}
    return found


def cell_text(value: Any) -> str:
    """A value in a cell: words as they are, anything else as in a hump file; '' for none."""
    return "" if value is None else value if isinstance(value, str) else value_text(value)


def from_csv(content: str, name: str, file: str) -> HumpEntry:
    """The hump in the table `content`, whose cells have commas, semicolons or tabs between them; `InputError` with all
    faults, each with its line."""
    rows = rows_in(content, file)
    columns = [each.strip() for each in rows[0][1]] if rows else []
    told = [
        f"{file}, line 1: the column {shown_key(each)} is unknown; {near_miss(each[:40], (KIND, *COLUMNS))}"
        for each in columns
        if each not in COLUMNS and each not in (KIND, "")
    ]
    if KIND not in columns:
        told.append(f"{file}, line 1: the column {KIND} is missing; it tells {HUMP}, {', '.join(ELEMENTS)}")
    if told:
        raise InputError(*told)
    found = tree_of(columns, rows[1:], file)
    try:
        with in_file(file):
            hump = hump_at(found.tree, lambda: found.lines, name, file)
    except InputError as fault:
        raise InputError(*found.faults, *fault.sentences) from None
    if found.faults:
        raise InputError(*found.faults)
    return hump


@dataclass(frozen=True)
class CsvTree:
    """The tables of a hump file in a table: on which line each of its places stands, and what is at fault in the column
    of kinds."""

    tree: Tree
    lines: dict[Place, int]
    faults: list[str]


def rows_in(content: str, file: str) -> list[tuple[int, list[str]]]:
    """The rows, each with its line; what stands most often in the first line stands between cells."""
    first = content.split("\n", 1)[0]
    reader = csv.reader(io.StringIO(content), delimiter=max(",;\t", key=first.count))
    try:
        return [(reader.line_num, row) for row in reader]
    except csv.Error as error:
        raise InputError(f"{file}, line {reader.line_num}: this is no CSV ({error}); save the table anew") from None


def tree_of(columns: Sequence[str], rows: Iterable[tuple[int, Sequence[str]]], file: str) -> CsvTree:
    """The tables of a hump file; `rows` with their lines."""
    hump: Tree = {}
    found = CsvTree({"format": FORMAT, "version": VERSION, "hump": hump}, {}, [])
    for line, row in rows:
        cells = {name: cell.strip() for name, cell in zip(columns, row, strict=False) if name and cell.strip()}
        kind = cells.pop(KIND, "")
        if kind == HUMP:
            for name, cell in cells.items():
                of_hump = name in OF_HUMP
                (hump if of_hump else found.tree)[name] = value_of(cell, COLUMNS[name])
                found.lines[(HUMP, name) if of_hump else (name,)] = line
        elif kind in ELEMENTS:
            listed = hump.setdefault(kind, [])
            found.lines[(HUMP, kind, len(listed))] = line
            listed.append(nested(cells))
        elif kind or cells:
            kinds = ", ".join((HUMP, *ELEMENTS))
            found.faults.append(f"{file}, line {line}: {KIND} is {shown(kind)}; it must be one of {kinds}")
    return found


def nested(cells: Mapping[str, str]) -> Tree:
    """A row with its tables."""
    row: Tree = {}
    for name, cell in cells.items():
        *tables, key = name.split(".")
        inner = row
        for each in tables:
            inner = inner.setdefault(each, {})
        inner[key] = value_of(cell, COLUMNS[name])
    return row


def value_of(cell: str, key: Key) -> Any:
    """What a cell means; the words themselves where it is no value of a hump file."""
    if key.form in (text, short_text):
        return cell
    try:
        return tomllib.loads(f"v = {cell.replace(',', '.') if NUMBER.fullmatch(cell) else cell}")["v"]
    except (tomllib.TOMLDecodeError, RecursionError, ValueError):
        return cell
