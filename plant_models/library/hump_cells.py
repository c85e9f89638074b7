"""Rows of a hump file: keys checked against what they may hold, types filled in, each value with place and origin."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

from plant_models.errors import PlantError
from plant_models.library.data_file import form_name, number, number_or_pairs, pairs, shown, shown_key
from plant_models.library.near_miss import near_miss
from plant_models.library.sourced_value import CONFIDENCES
from plant_models.library.toml_lines import Place

SOURCED: Final = ("value", "source", "confidence")
"""Keys of a number that tells where it is from."""


class HumpFileFault(PlantError):
    """What is at fault in a hump file, and at which `place` of it."""

    def __init__(self, place: Place, sentence: str) -> None:
        super().__init__(sentence)
        self.place = place


class HumpFileFaults(PlantError):
    """All that is at fault in the rows of a hump file."""

    def __init__(self, *faults: HumpFileFault) -> None:
        super().__init__("; ".join(map(str, faults)))
        self.faults = faults


@dataclass(frozen=True)
class Key:
    """What a key holds: its unit ('' where it is no number) and its form, which gives None for a wrong value."""

    unit: str
    form: Callable[[object], Any]


@dataclass(frozen=True)
class Origin:
    """Where numbers are from, as `SourcedValue` has it; both '' where the file does not tell."""

    source: str = ""
    confidence: str = ""


@dataclass(frozen=True)
class Cell:
    """A checked value, its place in the file, and for a number its unit and origin."""

    value: Any
    place: Place
    unit: str
    origin: Origin


Schema = Mapping[str, "Key | Schema"]
Cells = dict[str, "Cell | Cells"]


def text(raw: object) -> str | None:
    """A non-empty string of printable characters."""
    return raw if isinstance(raw, str) and raw and raw.isprintable() else None


def texts(raw: object) -> tuple[str, ...] | None:
    """A list of non-empty strings of printable characters."""
    items = [text(x) for x in raw] if isinstance(raw, list) else [None]
    return tuple(x for x in items if x is not None) if None not in items else None


def whole(raw: object) -> int | None:
    """A whole number."""
    return raw if isinstance(raw, int) and not isinstance(raw, bool) else None


def wholes(raw: object) -> tuple[int, ...] | None:
    """A list of whole numbers."""
    items = [whole(x) for x in raw] if isinstance(raw, list) else [None]
    return tuple(x for x in items if x is not None) if None not in items else None


def truth(raw: object) -> bool | None:
    """True or false."""
    return raw if isinstance(raw, bool) else None


def some_numbers(raw: object) -> tuple[float, ...] | None:
    """A list of finite numbers."""
    items = [number(x) for x in raw] if isinstance(raw, list) else [None]
    return tuple(x for x in items if x is not None) if None not in items else None


def triples(raw: object) -> tuple[tuple[float, float, float], ...] | None:
    """A list of [from_m, to_m, turn_deg], each of three finite numbers."""
    items = [some_numbers(x) for x in raw] if isinstance(raw, list) else [None]
    rows = [(x[0], x[1], x[2]) for x in items if x is not None and len(x) == 3]
    return tuple(rows) if len(rows) == len(items) else None


def some_pairs(raw: object) -> tuple[tuple[float, float], ...] | None:
    """A list of pairs of finite numbers."""
    return () if raw == [] else pairs(raw)


EDGE: Final[Schema] = {
    "to": Key("", whole),
    "length_m": Key("m", number),
    "grade_permille": Key("permille", number_or_pairs),
    "curves": Key("m, m, degrees", triples),
    "point_sensors_m": Key("m", some_numbers),
    "radars_m": Key("m", some_pairs),
}
BRANCH: Final[Schema] = {**EDGE, "turn_deg": Key("degrees", number), "fouling_m": Key("m", number)}
COUNTED: Final[Schema] = {"number": Key("", whole), "axle_counters": Key("", truth)}
JOINTS: Final[Schema] = {"entry_joint_m": Key("m", number), "exit_joint_m": Key("m", number)}

ELEMENTS: Final[Mapping[str, Schema]] = {
    "signal": {"number": Key("", whole), "next": EDGE},
    "switch": {
        **COUNTED,
        **JOINTS,
        "throw_s": Key("s", number),
        "relay_s": Key("s", number),
        "left": BRANCH,
        "right": BRANCH,
    },
    "retarder": {
        **COUNTED,
        **JOINTS,
        "position": Key("", text),
        "zones_m": Key("m", pairs),
        "book": Key("", text),
        "aim_tables": Key("", texts),
        "exit_std_m_s": Key("m/s", number),
        "next": EDGE,
    },
    "section": {
        **COUNTED,
        "length_m": Key("m", number),
        "track": Key("", whole),
        "standing_m": Key("m", number),
        "next": EDGE,
    },
}
"""What a row of each kind may hold; any table of it may name a `type`, whose keys stand for those that it has not."""

CONTROLLERS: Final = ("book", "exit_std_m_s")
"""What tells the controller of a retarder: one of these in a table. A row that has one takes none from its type."""


@dataclass
class TypeTables:
    """The tables `[type.NAME]` of a file, and which of them a row has named."""

    tables: Mapping[str, Any]
    origin: Origin
    used: set[str]

    def cells(self, name: object, schema: Schema, place: Place) -> Cells:
        """The cells of the type `name`, which is named at `place`."""
        known = text(name)
        if known is None or known not in self.tables:
            raise HumpFileFault(
                place, f"type is {shown(name)}, which is no type of this file; {near_miss(str(name)[:40], self.tables)}"
            )
        self.used.add(known)
        return checked_cells(self.tables[known], schema, ("type", known), self.origin, self, within_type=True)


def checked_cells(
    raw: object, schema: Schema, place: Place, origin: Origin, types: TypeTables, within_type: bool = False
) -> Cells:
    """The cells of the table `raw`, its type filled in; `HumpFileFault` for a key or value that may not be there."""
    if not isinstance(raw, dict):
        raise HumpFileFault(place, f"this is {shown(raw)}; it must be a table")
    table = dict(raw)
    own = origin_of(table, place, origin)
    below: Cells = {}
    if "type" in table and not within_type:
        below = types.cells(table.pop("type"), schema, (*place, "type"))
    cells: Cells = {}
    for name, value in table.items():
        expected = schema.get(name)
        if expected is None:
            raise HumpFileFault((*place, name), f"unknown key {shown_key(name)}; {near_miss(name[:40], schema)}")
        where = (*place, name)
        if isinstance(expected, Key):
            cells[name] = checked_cell(value, name, expected, where, own)
        else:
            cells[name] = checked_cells(value, expected, where, own, types)
    if all(key in cells for key in CONTROLLERS):
        told = " and ".join(CONTROLLERS)
        raise HumpFileFault(
            (*place, CONTROLLERS[0]), f"{told} are both given; give the one that tells what controls the retarder"
        )
    return merged(below, cells)


def origin_of(table: dict[str, Any], place: Place, around: Origin) -> Origin:
    """Remove `source` and `confidence` from a table; what is missing is as `around`."""
    found = around
    if "source" in table:
        source = text(table.pop("source"))
        if source is None:
            raise HumpFileFault((*place, "source"), "source must be a non-empty string of printable characters")
        found = Origin(source, "")
    if "confidence" in table:
        confidence = table.pop("confidence")
        if confidence not in CONFIDENCES:
            raise HumpFileFault(
                (*place, "confidence"), f"confidence is {shown(confidence)}; it must be one of {', '.join(CONFIDENCES)}"
            )
        found = replace(found, confidence=confidence)
    return found


def checked_cell(raw: object, name: str, key: Key, place: Place, origin: Origin) -> Cell:
    """One value: by itself, or where it is a number, a table of `SOURCED`."""
    if key.unit and isinstance(raw, dict):
        table = dict(raw)
        origin = origin_of(table, place, origin)
        for part in table:
            if part != "value":
                raise HumpFileFault(
                    (*place, part), f"unknown key {name}.{shown_key(part)}; {near_miss(part[:40], SOURCED)}"
                )
        if "value" not in table:
            raise HumpFileFault(place, f"key {name}.value is missing")
        raw = table["value"]
    value = key.form(raw)
    if value is None:
        raise HumpFileFault(place, f"{name} is {shown(raw)}; it must be {form_name(key.form)}")
    return Cell(value, place, key.unit, origin)


def merged(below: Cells, above: Cells) -> Cells:
    """`above`, and from `below` what it has not, in tables too."""
    result = dict(below)
    if any(key in above for key in CONTROLLERS):
        result = {key: cell for key, cell in result.items() if key not in CONTROLLERS}
    for name, cell in above.items():
        under = result.get(name)
        result[name] = merged(under, cell) if isinstance(under, dict) and isinstance(cell, dict) else cell
    return result
