"""A hump of the library or of a user's file: the graph, and where each of its numbers is from."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

from plant_models.errors import PlantError, near_miss
from plant_models.hump import HumpGraph
from plant_models.hump.ranges import in_brackets
from plant_models.library.data_file import parse_toml, shown, shown_key
from plant_models.library.hump_cells import SOURCED, Cell, Cells, Origin, TypeTables, origin_of
from plant_models.library.hump_forms import ForCars, FoundFaults, for_cars, short_text, text, texts
from plant_models.library.hump_rows import HumpRows
from plant_models.library.library import BUILT_IN, HUMPS, Library, TypeFileError
from plant_models.library.sourced_value import SourcedValue, Value
from plant_models.library.toml_lines import Place, line_among, places_of

FORMAT: Final = "hump"
VERSION: Final = 1
MOST_TOLD: Final = 50
"""Faults that are told at once; one mistake may stand in hundreds of rows."""

TOP: Final = ("format", "version", "title", "notes", "source", "confidence", "for_cars", "type", "hump")


@dataclass(frozen=True)
class HumpEntry:
    """A hump by name and `title`; `provenance`: every number of its file, under its key there, with origin.

    A value of several numbers is told as they stand in the file, one after the other. `cars`: those that it is for,
    None where the file does not say; `remarks`: a sentence for each key of the file that has no effect.
    """

    name: str
    title: str
    notes: tuple[str, ...]
    graph: HumpGraph
    provenance: tuple[SourcedValue, ...] = ()
    cars: ForCars | None = None
    remarks: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return f"HumpEntry({self.name}: {self.title}, {len(self.graph.tracks)} tracks)"


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

    `TypeFileError` with a sentence for every fault: file, line, element, value, what is allowed.
    """
    return hump_at(tree, lambda: places_of(content), name, place)


def hump_at(tree: Mapping[str, Any], lines_of: Callable[[], Mapping[Place, int]], name: str, place: str) -> HumpEntry:
    """The same of a `tree` whose places stand on the lines that `lines_of` gives."""
    found = FoundFaults()
    entry = entry_from(dict(tree), name, found)
    if entry is not None and not found:
        return entry
    lines = lines_of()
    told = [
        f"{place}, line {line_among(lines, each.place) or 1}: {label(tree, each.place)}{each}"
        for each in found.faults[:MOST_TOLD]
    ]
    more = len(found) - MOST_TOLD
    raise TypeFileError(*told, *([f"{place}: {more} more faults"] if more > 0 else []))


def entry_from(tree: dict[str, Any], name: str, found: FoundFaults) -> HumpEntry | None:
    """The hump in `tree`; what is at fault goes to `found`, and then there may be none."""
    if not {"format", "version", "hump"} & tree.keys():
        found.add((), f'key format is missing; a hump file has format = "{FORMAT}"')
        return None
    for key in tree:
        if key not in TOP:
            found.add((key,), f"unknown key {shown_key(key)}; {near_miss(key[:40], TOP)}")
    for key, wanted in (("format", FORMAT), ("version", VERSION)):
        if key not in tree:
            found.add((), f"key {key} is missing; a hump file has {key} = {wanted!r}".replace("'", '"'))
        elif tree[key] != wanted or type(tree[key]) is not type(wanted):
            told = f"{key} is {shown(tree[key])}; this program reads hump files of {key} {wanted!r}"
            found.add((key,), told.replace("'", '"'))
    title = text(tree.get("title"))
    if title is None:
        found.add(("title",), "title must be a non-empty string of printable characters")
    notes = texts(tree.get("notes", []))
    if notes is None:
        found.add(("notes",), "notes must be a list of non-empty strings of printable characters")
    cars: ForCars | None = None
    try:
        cars = for_cars(tree["for_cars"]) if "for_cars" in tree else None
    except ValueError as error:
        found.add(("for_cars",), str(error))
    origin = origin_of(tree, (), Origin(), found)
    types = TypeTables(table_of(tree, "type", {}, found), origin, found)
    hump = table_of(tree, "hump", None, found)
    if not isinstance(tree.get("hump"), dict):
        return None
    rows = HumpRows.read(hump, types, origin)
    graph = rows.graph()
    for key in types.tables:
        if key not in types.used:
            found.add(("type", key), f"no element names the type {shown_key(key)}; take it out")
    if graph is None:
        return None
    remarks = tuple(without_effect(rows, types))
    return HumpEntry(name, title or "", notes or (), graph, tuple(provenance(rows.cells)), cars, remarks)


def table_of(
    tree: Mapping[str, Any], key: str, absent: dict[str, Any] | None, faults: FoundFaults
) -> Mapping[str, Any]:
    """The table under `key`; an empty one where it is at fault."""
    found = tree.get(key, absent)
    if isinstance(found, dict):
        return found
    if found is None:
        faults.add((), f"the table [{key}] is missing")
    else:
        faults.add((key,), f"{key} is {shown(found)}; it must be a table")
    return {}


def without_effect(rows: HumpRows, types: TypeTables) -> Iterator[str]:
    """A sentence for each key of a type that counts in no row."""
    counted = {cell.place for cells in rows.cells for cell in leaves(cells)}
    for name in sorted(types.used):
        for place in places_in(types.tables[name], ("type", name)):
            if not any(each[: len(place)] == place or place[: len(each)] == each for each in counted):
                key = ".".join(map(str, place))
                yield f"{key} has no effect: every row that names the type has its own"


def places_in(table: Mapping[str, Any], place: Place) -> Iterator[Place]:
    """The place of each value in nested tables, but for origins; a number with its origin is one value."""
    for key, value in table.items():
        if key in SOURCED[1:]:
            continue
        if isinstance(value, dict) and "value" not in value:
            yield from places_in(value, (*place, key))
        else:
            yield (*place, key)


def label(tree: Mapping[str, Any], place: Place) -> str:
    """What a message calls the thing at `place`: 'switch 7: left: ', 'type.ladder: ', or '' for the whole file."""
    if place[:1] == ("type",) and len(place) > 1:
        return ": ".join((f"type.{shown_key(str(place[1]))}", *(str(key) for key in place[2:-1]), ""))
    if place[:1] == ("hump",) and len(place) > 2:
        kind, row = place[1], place[2]
        listed = tree["hump"][kind]
        raw = listed[row] if isinstance(listed, list) and isinstance(row, int) else None
        given = raw.get("number") if isinstance(raw, dict) else None
        usable = isinstance(given, int) and not isinstance(given, bool)
        told = short_text(raw.get("name")) if isinstance(raw, dict) else None
        called = f"{kind} {given}{in_brackets(told)}" if usable else f"{kind}[{row}]"
        inner = [str(key) for key in place[3:-1] if key != "number"]
        return ": ".join((called, *inner, ""))
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
