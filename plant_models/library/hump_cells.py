"""Rows of a hump file: keys checked against what they may hold, types filled in, each value with place and origin."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final

from plant_models.errors import close_name, near_miss
from plant_models.hump.ranges import (
    ENTRY_JOINT_M,
    EXIT_STD_M_S,
    FOULING_M,
    LENGTH_M,
    RELAY_S,
    RETARDER_EXIT_JOINT_M,
    STANDING_M,
    SWITCH_EXIT_JOINT_M,
    THROW_S,
    TRACK,
    TURN_DEG,
    Range,
)
from plant_models.library.data_file import form_name, number, number_or_pairs, pairs, shown, shown_key
from plant_models.library.hump_forms import (
    FoundFaults,
    HumpFileFault,
    in_unit,
    short_text,
    some_numbers,
    some_pairs,
    text,
    texts,
    triples,
    truth,
    whole,
    words_for,
)
from plant_models.library.sourced_value import CONFIDENCES
from plant_models.library.toml_lines import Place

SOURCED: Final = ("value", "source", "confidence")
"""Keys of a number that tells where it is from."""


@dataclass(frozen=True)
class Key:
    """What a key holds: its unit ('' where it is no number), its form, which gives None for a wrong value, and what a
    single number may be."""

    unit: str
    form: Callable[[object], Any]
    range: Range | None = None


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

    @property
    def faulty(self) -> bool:
        """The key is there, and its value is at fault."""
        return self.value is None


Schema = Mapping[str, "Key | Schema"]
Cells = dict[str, "Cell | Cells"]


def faulty(place: Place) -> Cell:
    """What stands for a key at `place` whose value is at fault."""
    return Cell(None, place, "", Origin())


EDGE: Final[Schema] = {
    "to": Key("", whole),
    "length_m": Key("m", number, LENGTH_M),
    "grade_permille": Key("permille", number_or_pairs),
    "curves": Key("m, m, degrees", triples),
    "point_sensors_m": Key("m", some_numbers),
    "radars_m": Key("m", some_pairs),
}
BRANCH: Final[Schema] = {
    **EDGE,
    "turn_deg": Key("degrees", number, TURN_DEG),
    "fouling_m": Key("m", number, FOULING_M),
}
NAMED: Final[Schema] = {"number": Key("", whole), "name": Key("", short_text), "axle_counters": Key("", truth)}

ELEMENTS: Final[Mapping[str, Schema]] = {
    "signal": {"number": Key("", whole), "next": EDGE},
    "switch": {
        **NAMED,
        "entry_joint_m": Key("m", number, ENTRY_JOINT_M),
        "exit_joint_m": Key("m", number, SWITCH_EXIT_JOINT_M),
        "throw_s": Key("s", number, THROW_S),
        "relay_s": Key("s", number, RELAY_S),
        "left": BRANCH,
        "right": BRANCH,
    },
    "retarder": {
        **NAMED,
        "entry_joint_m": Key("m", number, ENTRY_JOINT_M),
        "exit_joint_m": Key("m", number, RETARDER_EXIT_JOINT_M),
        "position": Key("", text),
        "zones_m": Key("m", pairs),
        "book": Key("", text),
        "aim_tables": Key("", texts),
        "exit_std_m_s": Key("m/s", number, EXIT_STD_M_S),
        "next": EDGE,
    },
    "section": {
        **NAMED,
        "length_m": Key("m", number, LENGTH_M),
        "track": Key("", whole, TRACK),
        "standing_m": Key("m", number, STANDING_M),
        "next": EDGE,
    },
}
"""What a row of each kind may hold; any table of it may name a `type`, whose keys stand for those that it has not."""

PROFILE: Final = Key("m, permille", pairs)
"""The key `profile_from_crest`, metres from the crest."""

ELSEWHERE: Final[Mapping[str, str]] = {
    **dict.fromkeys(
        ("exit_speed_m_s", "exit_m_s", "target_m_s", "speed_m_s"),
        "a hump file holds no exit speeds; the configuration of a trial does (retarder-synth init trial)",
    ),
    "name": "only switches, retarders and sections have names",
    "radius_m": "give curves, [from_m, to_m, degrees]",
}
"""Keys that are often looked for in a row, and what to do."""

CONTROLLERS: Final = ("book", "exit_std_m_s")
"""What tells the controller of a retarder: one of these in a table. A row that has one takes none from its type."""


@dataclass
class TypeTables:
    """The tables `[type.NAME]` of a file, those that rows have named, and what is found at fault in types and rows."""

    tables: Mapping[str, Any]
    origin: Origin
    found: FoundFaults
    used: set[str] = field(default_factory=set)
    checked: dict[tuple[str, int], Cells] = field(default_factory=dict)

    def cells(self, name: object, schema: Schema, place: Place) -> Cells:
        """The cells of the type `name`, which is named at `place`."""
        known, word = text(name), str(name)[:40]
        if known is None or known not in self.tables:
            hint = near_miss(word, self.tables) if self.tables else "the file has none"
            self.found.add(place, f"type is {shown(name)}, which is no type of this file; {hint}")
            self.used.add(close_name(word, self.tables) or "")
            return of_unknown_type(schema, place)
        self.used.add(known)
        key = known, id(schema)
        if key not in self.checked:
            origin, at = self.origin, ("type", known)
            self.checked[key] = checked_cells(self.tables[known], schema, at, origin, self, within_type=True)
        return self.checked[key]


def checked_cells(
    raw: object, schema: Schema, place: Place, origin: Origin, types: TypeTables, within_type: bool = False
) -> Cells:
    """The cells of the table `raw`, its type filled in; what may not be there is added to what `types` has found.

    `HumpFileFault` where `raw` is no table.
    """
    if not isinstance(raw, dict):
        raise HumpFileFault(place, f"this is {shown(raw)}; it must be a table")
    table = dict(raw)
    own = origin_of(table, place, origin, types.found)
    below: Cells = {}
    if "type" in table and not within_type:
        with types.found.collecting():
            below = types.cells(table.pop("type"), schema, (*place, "type"))
    cells: Cells = {}
    for name, value in table.items():
        where, expected = (*place, name), schema.get(name)
        if expected is None:
            hint = ELSEWHERE.get(name) or near_miss(name[:40], schema)
            types.found.add(where, f"unknown key {shown_key(name)}; {hint}")
            meant = None if name in ELSEWHERE else close_name(name[:40], schema)
            if meant is not None and meant not in table:
                cells[meant] = faulty(where)
        elif isinstance(expected, Key):
            cells[name] = checked_cell(value, name, expected, where, own, types.found)
        else:
            with types.found.collecting():
                cells[name] = checked_cells(value, expected, where, own, types)
            cells.setdefault(name, faulty(where))
    if all(key in cells for key in CONTROLLERS):
        told = " and ".join(CONTROLLERS)
        types.found.add(
            (*place, CONTROLLERS[0]), f"{told} are both given; give the one that tells what controls the retarder"
        )
        del cells[CONTROLLERS[1]]
    return merged(below, cells)


def of_unknown_type(schema: Schema, place: Place) -> Cells:
    """What a row has of a type that is not there: in each of its tables the mark that keys may not be missing."""
    inner = {key: of_unknown_type(below, place) for key, below in schema.items() if not isinstance(below, Key)}
    return {"type": faulty(place), **inner}


def origin_of(table: dict[str, Any], place: Place, around: Origin, faults: FoundFaults) -> Origin:
    """Remove `source` and `confidence` from a table; what is missing is as `around`."""
    found = around
    if "source" in table:
        source = text(table.pop("source"))
        if source is None:
            faults.add((*place, "source"), "source must be a non-empty string of printable characters")
        found = Origin(source or "", "")
    if "confidence" in table:
        confidence = table.pop("confidence")
        if confidence not in CONFIDENCES:
            told = f"confidence is {shown(confidence)}; it must be one of {', '.join(CONFIDENCES)}"
            faults.add((*place, "confidence"), told)
            return found
        found = replace(found, confidence=confidence)
    return found


def checked_cell(raw: object, name: str, key: Key, place: Place, origin: Origin, found: FoundFaults) -> Cell:
    """One value: by itself, or where it is a number, a table of `SOURCED`; without a value where it is at fault."""
    bad = faulty(place)
    if key.unit and isinstance(raw, dict):
        table = dict(raw)
        origin = origin_of(table, place, origin, found)
        for part in table:
            if part != "value":
                found.add((*place, part), f"unknown key {name}.{shown_key(part)}; {near_miss(part[:40], SOURCED)}")
        if "value" not in table:
            found.add(place, f"key {name}.value is missing")
            return bad
        raw = table["value"]
    value = key.form(in_unit(raw, key.unit) if isinstance(raw, str) else raw)
    if value is None:
        found.add(place, f"{name} is {shown(raw)}; it must be {words_for(raw, key.unit) or form_name(key.form)}")
        return bad
    for sentence in key.range.faults(name, value) if key.range is not None else ():
        found.add(place, sentence)
        return bad
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
