"""A hump of the library or of a user's file: the graph, and where each of its numbers is from."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

from plant_models.errors import PlantError
from plant_models.hump import HumpError, HumpGraph, Vertex
from plant_models.library.data_file import parse_toml, shown, shown_key
from plant_models.library.hump_cars import ForCars, for_cars
from plant_models.library.hump_cells import (
    ELEMENTS,
    Cell,
    Cells,
    HumpFileFault,
    HumpFileFaults,
    Origin,
    TypeTables,
    checked_cells,
    origin_of,
    text,
    texts,
    wholes,
)
from plant_models.library.hump_elements import ElementFault, element_from
from plant_models.library.library import BUILT_IN, Library
from plant_models.library.near_miss import near_miss
from plant_models.library.sourced_value import SourcedValue, Value
from plant_models.library.toml_lines import Place, line_of
from plant_models.library.type_file import HUMPS, TypeFileError

FORMAT: Final = "hump"
VERSION: Final = 1
MOST_TOLD: Final = 20
"""Faults that are told at once; one mistake may stand in hundreds of rows."""

TOP: Final = ("format", "version", "title", "notes", "source", "confidence", "for_cars", "type", "hump")


@dataclass(frozen=True)
class HumpEntry:
    """A hump by name and `title`; `provenance`: every number of its file, under its key there, with origin.

    A value of several numbers is told as they stand in the file, one after the other. `cars`: those that it is for,
    None where the file does not say.
    """

    name: str
    title: str
    notes: tuple[str, ...]
    graph: HumpGraph
    provenance: tuple[SourcedValue, ...] = ()
    cars: ForCars | None = None


def load_hump(name: str, library: Library = BUILT_IN) -> HumpEntry:
    """The hump `name` of the library; `PlantError` with a hint if there is none, or of a fault in its file."""
    file = library.file(HUMPS, name)
    try:
        tree = parse_toml(file.text)
    except PlantError as error:
        raise TypeFileError(f"{file.place}: {error}") from None
    return hump_from(tree, file.text, name, file.place)


def hump_names(library: Library = BUILT_IN) -> tuple[str, ...]:
    """Names of the humps of the library, sorted."""
    return library.names(HUMPS)


def hump_from(tree: Mapping[str, Any], content: str, name: str, place: str) -> HumpEntry:
    """The hump that the TOML `content` of the file `place` describes, parsed into `tree`.

    `TypeFileError`, of its rows with a sentence for each fault: file, line, element, value, what is allowed.
    """
    try:
        return entry_from(dict(tree), name)
    except HumpFileFault as fault:
        faults: tuple[HumpFileFault, ...] = (fault,)
    except HumpFileFaults as found:
        faults = found.faults
    told = [
        f"{place}, line {line_of(content, each.place)}: {label(tree, each.place)}{each}" for each in faults[:MOST_TOLD]
    ]
    more = len(faults) - MOST_TOLD
    raise TypeFileError(*told, *([f"{place}: {more} more faults"] if more > 0 else []))


def entry_from(tree: dict[str, Any], name: str) -> HumpEntry:
    """The hump in `tree`; `HumpFileFault`."""
    for key in tree:
        if key not in TOP:
            raise HumpFileFault((key,), f"unknown key {shown_key(key)}; {near_miss(key[:40], TOP)}")
    for key, wanted in (("format", FORMAT), ("version", VERSION)):
        if key not in tree:
            raise HumpFileFault((), f"key {key} is missing; a hump file has {key} = {wanted!r}".replace("'", '"'))
        if tree[key] != wanted or type(tree[key]) is not type(wanted):
            told = f"{key} is {shown(tree[key])}; this program reads hump files of {key} {wanted!r}"
            raise HumpFileFault((key,), told.replace("'", '"'))
    title = text(tree.get("title"))
    if title is None:
        raise HumpFileFault(("title",), "title must be a non-empty string of printable characters")
    notes = texts(tree.get("notes", []))
    if notes is None:
        raise HumpFileFault(("notes",), "notes must be a list of non-empty strings of printable characters")
    try:
        cars = for_cars(tree["for_cars"]) if "for_cars" in tree else None
    except ValueError as error:
        raise HumpFileFault(("for_cars",), str(error)) from None
    origin = origin_of(tree, (), Origin())
    types = TypeTables(table_of(tree, "type", {}), origin, set())
    hump = table_of(tree, "hump", None)
    graph, cells = graph_from(hump, types, origin)
    unused = next((key for key in types.tables if key not in types.used), None)
    if unused is not None:
        raise HumpFileFault(("type", unused), f"no element names the type {shown_key(unused)}; take it out")
    return HumpEntry(name, title, notes, graph, tuple(provenance(cells)), cars)


def table_of(tree: Mapping[str, Any], key: str, absent: dict[str, Any] | None) -> dict[str, Any]:
    """The table under `key`."""
    found = tree.get(key, absent)
    if found is None:
        raise HumpFileFault((), f"the table [{key}] is missing")
    if not isinstance(found, dict):
        raise HumpFileFault((key,), f"{key} is {shown(found)}; it must be a table")
    return found


def graph_from(hump: Mapping[str, Any], types: TypeTables, origin: Origin) -> tuple[HumpGraph, list[Cells]]:
    """The graph that the table `[hump]` describes, and the cells of its rows."""
    known = ("leads", *ELEMENTS)
    for key in hump:
        if key not in known:
            raise HumpFileFault(("hump", key), f"unknown key {shown_key(key)}; {near_miss(key[:40], known)}")
    leads = wholes(hump.get("leads"))
    if leads is None:
        raise HumpFileFault(("hump", "leads"), "leads must be a list of whole numbers, the signal at each crest")
    rows: dict[int, Row] = {}
    faults: dict[tuple[Place, str], HumpFileFault] = {}  # that of a type is told once, however many rows name it
    for kind in ELEMENTS:
        listed = hump.get(kind, [])
        if not isinstance(listed, list):
            raise HumpFileFault(("hump", kind), f"{kind} is {shown(listed)}; it must be a list of tables")
        for number, raw in enumerate(listed):
            try:
                row = row_from(raw, ("hump", kind, number), origin, types)
                require_new(row, rows)
                rows[row.vertex.number] = row
            except HumpFileFault as fault:
                faults.setdefault((fault.place, str(fault)), fault)
    if faults:
        raise HumpFileFaults(*faults.values())
    try:
        return HumpGraph(tuple(row.vertex for row in rows.values()), leads), [row.cells for row in rows.values()]
    except HumpError as error:
        of_row = None if error.element is None else rows.get(error.element)
        at = ("hump", "leads") if of_row is None else of_row.place
        raise HumpFileFault(at, unnamed(error, str(at[1]))) from None


@dataclass(frozen=True)
class Row:
    """A row of the table `[hump]`: the element, its cells, and the place of the row in the file."""

    vertex: Vertex
    cells: Cells
    place: Place


def row_from(raw: object, place: Place, origin: Origin, types: TypeTables) -> Row:
    """The row `raw` at `place`; `HumpFileFault`."""
    kind = str(place[1])
    cells = checked_cells(raw, ELEMENTS[kind], place, origin, types)
    try:
        return Row(element_from(kind, cells), cells, place)
    except ElementFault as fault:
        raise HumpFileFault(fault.place or place, str(fault)) from None
    except HumpError as error:  # a number out of its group, whose sentence names the element itself
        raise HumpFileFault((*place, "number"), unnamed(error, kind)) from None


def require_new(row: Row, rows: Mapping[int, Row]) -> None:
    """`HumpFileFault` where one of the `rows` before has the number of `row`."""
    same = rows.get(row.vertex.number)
    if same is not None:
        raise HumpFileFault(
            (*row.place, "number"),
            f"{same.place[1]}[{same.place[2]}] has the number {row.vertex.number}, too; numbers must be unique",
        )


def unnamed(error: HumpError, kind: str) -> str:
    """The sentence of `error` without the element at its beginning, which the place tells."""
    named = f"{kind} {error.element}: "
    return str(error).removeprefix(named)


def label(tree: Mapping[str, Any], place: Place) -> str:
    """What a message calls the thing at `place`: 'switch 7: left: ', 'type.ladder: ', or '' for the whole file."""
    if place[:1] == ("type",) and len(place) > 1:
        return ": ".join((f"type.{shown_key(str(place[1]))}", *(str(key) for key in place[2:-1]), ""))
    if place[:1] == ("hump",) and len(place) > 2:
        kind, row = place[1], place[2]
        raw = tree["hump"][kind][row]
        given = raw.get("number") if isinstance(raw, dict) else None
        usable = isinstance(given, int) and not isinstance(given, bool)
        name = f"{kind} {given}" if usable else f"{kind}[{row}]"
        inner = [str(key) for key in place[3:-1] if key != "number"]
        return ": ".join((name, *inner, ""))
    return ""


def provenance(rows: list[Cells]) -> Iterator[SourcedValue]:
    """Every number of the rows once, under its key in the file."""
    told: set[Place] = set()
    for cells in rows:
        for cell in leaves(cells):
            if cell.unit and cell.place not in told:
                told.add(cell.place)
                key = ".".join(map(str, cell.place))
                yield SourcedValue(key, flat(cell.value), cell.unit, None, cell.origin.source, cell.origin.confidence)


def leaves(cells: Cells) -> Iterator[Cell]:
    """Every cell of nested tables."""
    for cell in cells.values():
        if isinstance(cell, Cell):
            yield cell
        else:
            yield from leaves(cell)


def flat(value: Any) -> Value:
    """A number as it is; of nested lists, their numbers in order."""
    if isinstance(value, float):
        return value
    return tuple(number for item in value for number in (item if isinstance(item, tuple) else (item,)))
