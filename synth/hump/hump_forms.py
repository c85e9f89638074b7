"""A hump in other forms: the tables of a hump file, without types and origins, and as the text of one; a table for
spreadsheets, a row an element, with the keys of a hump file as columns.
"""

from __future__ import annotations

import csv
import io
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from plant_models.errors import near_miss
from plant_models.hump import Edge, Retarder, Signal, Switch, TrackSection, Vertex
from plant_models.library.data_file import shown, shown_key
from plant_models.library.hump_cells import ELEMENTS, PROFILE, Key, Schema
from plant_models.library.hump_elements import zones_of
from plant_models.library.hump_entry import FORMAT, VERSION, HumpEntry, hump_at
from plant_models.library.hump_forms import for_cars, short_text, text, texts, wholes
from plant_models.library.library import BUILT_IN, POSITIONS
from plant_models.library.toml_lines import Place
from synth.frame.faults import InputError
from synth.frame.settings.template import value_text
from synth.frame.sheet import to_workbook
from synth.retarder.configuration.plant_fault import in_file

Tree = dict[str, Any]

KINDS: Final = {Signal: "signal", Switch: "switch", Retarder: "retarder", TrackSection: "section"}


def hump_tree(hump: HumpEntry) -> Tree:
    """The tables; read again they give the same graph."""
    rows: Tree = {kind: [] for kind in ELEMENTS}
    for vertex in hump.graph.vertices:
        rows[KINDS[type(vertex)]].append(row_of(vertex))
    notes = {"notes": list(hump.notes)} if hump.notes else {}
    found = {kind: listed for kind, listed in rows.items() if listed}
    cars = {} if hump.cars is None else {"for_cars": hump.cars.table}
    head = {"format": FORMAT, "version": VERSION, "title": hump.title, **notes, **cars}
    return {**head, "hump": {"leads": list(hump.graph.leads), **found}}


def tree_toml(hump: HumpEntry) -> str:
    """The text of the file, a row a line."""
    tree = hump_tree(hump)
    lines = [f"{key} = {value_text(value)}" for key, value in tree.items() if key != "hump"]
    lines += ["", "[hump]", f"leads = {tree['hump']['leads']}"]
    for kind in ELEMENTS:
        if kind in tree["hump"]:
            lines += [f"{kind} = [", *(f"    {value_text(row)}," for row in tree["hump"][kind]), "]"]
    return "\n".join(lines) + "\n"


def row_of(vertex: Vertex) -> Tree:
    """An element as a row; keys that say what is so without them are left out."""
    row: Tree = {"number": vertex.number}
    if not isinstance(vertex, Signal) and vertex.name is not None:
        row["name"] = vertex.name
    match vertex:
        case Switch():
            row |= {key: getattr(vertex, key) for key in ("entry_joint_m", "exit_joint_m", "throw_s", "relay_s")}
            for side, branch in (("left", vertex.left), ("right", vertex.right)):
                row[side] = {**edge_of(branch.edge), "turn_deg": branch.turn_deg, "fouling_m": branch.fouling_m}
        case Retarder():
            row |= {key: getattr(vertex, key) for key in ("position", "entry_joint_m", "exit_joint_m")}
            row |= {} if is_of_library(vertex) else {"zones_m": [list(zone) for zone in vertex.zones_m]}
            row |= {key: getattr(vertex, key) for key in ("book", "exit_std_m_s") if getattr(vertex, key) is not None}
            row |= {"aim_tables": list(vertex.aim_tables)} if vertex.aim_tables else {}
        case TrackSection():
            row |= {} if vertex.is_last else {"length_m": vertex.length_m}
            row |= {} if vertex.track is None else {"track": vertex.track}
            row |= {"standing_m": vertex.standing_m} if vertex.standing_m else {}
    if not isinstance(vertex, Signal) and not vertex.axle_counters:
        row["axle_counters"] = False
    return row if isinstance(vertex, Switch) else {**row, "next": edge_of(vertex.next)}


def edge_of(edge: Edge) -> Tree:
    """An edge as a table."""
    grades = [list(each) for each in edge.grades]
    lists = {
        "curves": [[each.from_m, each.to_m, each.turn_deg] for each in edge.curves],
        "point_sensors_m": [each.at_m for each in edge.point_sensors],
        "radars_m": [[each.from_m, each.to_m] for each in edge.radars],
    }
    to = {} if edge.to is None else {"to": edge.to}
    grade = grades[0][1] if len(grades) == 1 else grades
    return {**to, "length_m": edge.length_m, "grade_permille": grade, **{k: v for k, v in lists.items() if v}}


def is_of_library(retarder: Retarder) -> bool:
    """Its zones are those of its position in the library."""
    named = retarder.position in BUILT_IN.names(POSITIONS)
    return named and zones_of(retarder.position) == retarder.zones_m


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
