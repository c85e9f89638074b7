"""A position of the library: a site with the retarders that stand there and its usual surroundings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

from plant_models.entry_speed import EntryLaw
from plant_models.errors import near_miss, require
from plant_models.friction import Friction
from plant_models.library.data_file import (
    Quantity,
    number,
    number_or_pairs,
    numbers,
    pairs,
    parse_toml,
    sourced_table,
    take_string,
    take_strings,
    telling,
)
from plant_models.library.entry_values import ENTRY, entry_law, entry_schema, with_entry
from plant_models.library.library import POSITIONS, RETARDERS, SENSORS, Library, TypeFile
from plant_models.library.retarder_entry import RetarderEntry, position_of, retarder_from
from plant_models.library.sensor_entry import sensor_from, sensor_of
from plant_models.library.sourced_value import SourcedTable, SourcedValue, Value
from plant_models.retarder import RetarderPosition
from plant_models.speed_sensor import DopplerSensor
from plant_models.track_profile import Approach, TrackProfile

RETARDER, SENSOR = "retarder.", "sensor."
ZONES = RETARDER + "zones_m"

PLACES = {"starts_m": Quantity("m", numbers)}
ZONES_STATED = {"zones_m": Quantity("m", pairs)}
"""Where the retarders stand: their beginnings (the type has their length), or both ends of each."""

TRACK = {"track.grade_permille": Quantity("permille, downhill positive", number_or_pairs)}
MEAN_CV: Final = "friction.mean_cv"
FRICTION = {
    "friction.common_cv": Quantity("1", number),
    "friction.axle_cv": Quantity("1", number),
    "friction.path_std": Quantity("1", number),
    "friction.correlation_length_m": Quantity("m", number),
    "friction.floor": Quantity("1", number),
    MEAN_CV: Quantity("1", number),
}
APPROACH: Final = "regulator.approach_m"
INITIAL_STAGE: Final = "regulator.initial_stage"
REGULATOR = {APPROACH: Quantity("m", number), INITIAL_STAGE: Quantity("stage", number)}

TARGETS = {"targets.exit_speeds_m_s": Quantity("m/s", numbers)}

NOT_STATED: Final = (
    SourcedValue(
        APPROACH, 0.0, "m", (0.0, 12.0), "not stated by the position: the regulator acts from the entrance", ""
    ),
    SourcedValue(INITIAL_STAGE, 0.0, "stage", (0.0, 31.0), "the brake is released when the cut ahead has left", ""),
    SourcedValue(MEAN_CV, 0.0, "1", (0.0, 0.3), "not stated by the position: the mean friction is taken as known", ""),
)
"""What stands for the keys that a position file may leave out."""

KEYS_OF_PLANT = {
    "retarder: ": "",
    "friction: ": "friction.",
    "entry: ": "entry.",
    "regulator: ": "regulator.",
    "track profile: grades_permille": "track.grade_permille",
    "track profile: starts_m": "track.grade_permille: starts_m",
}
"""How the plant's messages begin, and the keys of a position file that this means."""


@dataclass(frozen=True)
class PositionEntry:
    """A position with its surroundings (grade, entry speeds, friction, sensor, approach, exit speeds), with origins.

    `law`: the force law of its retarder type. `provenance`: every number behind the other fields, keys as in a
    configuration.
    """

    name: str
    title: str
    notes: tuple[str, ...]
    law: str
    position: RetarderPosition
    profile: TrackProfile
    entry: EntryLaw
    friction: Friction
    sensor: DopplerSensor
    approach: Approach
    target_speeds_m_s: tuple[float, ...]
    provenance: tuple[SourcedValue, ...]

    def __repr__(self) -> str:
        return f"PositionEntry({self.name}: {self.title})"

    def with_values(self, overrides: Mapping[str, Value]) -> PositionEntry:
        """This entry with the values under some dotted keys replaced by the user's.

        Raises `PlantError` for a key that the entry has not, and for a value that the plant refuses.
        """
        entry = {key.removeprefix(ENTRY): value for key, value in overrides.items() if key.startswith(ENTRY)}
        others = {key: value for key, value in overrides.items() if not key.startswith(ENTRY)}
        known = [v.key for v in self.provenance]
        for key in others:
            require(
                key in known,
                f"{key} is {others[key]!r}; the {self.law} force law of {self.name} has no such value: "
                f"{near_miss(key, known)}",
            )
        changed = with_entry(self.entry_provenance, entry)
        values = SourcedTable(self.provenance).replaced(others).values
        place = next(i for i, value in enumerate(values) if value.key.startswith(ENTRY))
        kept = [value for value in values if not value.key.startswith(ENTRY)]
        kept[place:place] = [replace(value, key=ENTRY + value.key) for value in changed]
        return entry_of(self.name, self.title, self.notes, self.law, SourcedTable(tuple(kept)))

    @property
    def entry_provenance(self) -> tuple[SourcedValue, ...]:
        """The numbers of the entry speeds, keys without 'entry.'."""
        return tuple(
            replace(value, key=value.key.removeprefix(ENTRY))
            for value in self.provenance
            if value.key.startswith(ENTRY)
        )


@dataclass(frozen=True)
class PositionFile:
    """What a position file says by itself; `retarder` and `sensor` are names of other types."""

    file: TypeFile
    title: str
    notes: tuple[str, ...]
    retarder: str
    sensor: str
    site: SourcedTable


def position_file(file: TypeFile) -> PositionFile:
    """The content of `file`; `TypeFileError` names file and key."""
    with telling(file.place, file.text, KEYS_OF_PLANT):
        tree = parse_toml(file.text)
        title, notes = take_string(tree, "title"), take_strings(tree, "notes")
        retarder, sensor = take_string(tree, "retarder"), take_string(tree, "sensor")
        return PositionFile(file, title, notes, retarder, sensor, sourced_table(tree, site_schema(tree), file.origin))


def site_schema(tree: Mapping[str, Any]) -> dict[str, Quantity]:
    """Every key of a position file, in the forms that this one has chosen."""
    entry = tree.get("entry")
    law = entry_schema(
        set(entry) & {"edges_m_s", "shares", "mean_m_s", "std_m_s"} if isinstance(entry, dict) else set()
    )
    keys = {ENTRY + key: quantity for key, quantity in law.items()}
    zones = ZONES_STATED if "zones_m" in tree else PLACES
    known = {**zones, **TRACK, **keys, **FRICTION, **REGULATOR, **TARGETS}
    left_out = {value.key for value in NOT_STATED if not states(tree, value.key)}
    return {key: quantity for key, quantity in known.items() if key not in left_out}


def states(tree: Mapping[str, Any], key: str) -> bool:
    """Whether the file has the dotted `key` of a section."""
    section, _, name = key.partition(".")
    inner = tree.get(section)
    return isinstance(inner, dict) and name in inner


def position_with_types(
    name: str, library: Library, retarder: str | None = None, sensor: str | None = None
) -> PositionEntry:
    """The position `name`; `retarder` and `sensor`, where given, stand in place of its own types.

    With another retarder than its own it is called by both names, for it is another position.
    `PlantError` with a hint where the library has no such type, `TypeFileError` for a fault in one of the files.
    """
    here = position_file(library.file(POSITIONS, name))
    with telling(here.file.place):
        of_type = library.file(RETARDERS, retarder or here.retarder)
        of_sensor = library.file(SENSORS, sensor or here.sensor)
    unit, radar = retarder_from(of_type), sensor_from(of_sensor)
    with telling(here.file.place, here.file.text, KEYS_OF_PLANT):
        table = SourcedTable(tuple(composed(here.site, unit, radar.provenance)))
        called = name if unit.name == here.retarder else f"{name}-with-{unit.name}"
        entry = entry_of(called, here.title, (*unit.notes, *here.notes), unit.law, table)
        require(
            entry.entry.high_m_s <= entry.position.max_entry_speed_m_s,
            f"entry: the highest speed is {entry.entry.high_m_s:g} m/s; a retarder {unit.name} takes at most "
            f"{entry.position.max_entry_speed_m_s:g} m/s",
        )
    return entry


def composed(site: SourcedTable, unit: RetarderEntry, sensor: tuple[SourcedValue, ...]) -> tuple[SourcedValue, ...]:
    """All numbers of a position in the order of a configuration, with its keys."""
    by_key = {value.key: value for value in site.values}
    zones = by_key.pop("zones_m", None) or zones_of(by_key.pop("starts_m"), unit.length_m)
    stated = {value.key: by_key.pop(value.key, value) for value in NOT_STATED}
    surroundings = [value for value in by_key.values() if value.key != "targets.exit_speeds_m_s"]
    return (
        replace(zones, key=ZONES),
        *(replace(value, key=RETARDER + value.key) for value in unit.drive.values),
        *surroundings,
        stated[MEAN_CV],
        *(replace(value, key=SENSOR + value.key) for value in sensor),
        *(stated[key] for key in REGULATOR),
        by_key["targets.exit_speeds_m_s"],
    )


def zones_of(starts: SourcedValue, length_m: float) -> SourcedValue:
    """The zones of equal retarders of `length_m` that begin at `starts`; the origin is that of their places."""
    assert isinstance(starts.value, tuple)
    zones = tuple((x, round(x + length_m, 6)) for x in starts.value if isinstance(x, float))
    return replace(starts, key="zones_m", value=zones)


def entry_of(name: str, title: str, notes: tuple[str, ...], law: str, table: SourcedTable) -> PositionEntry:
    """The plant values that the numbers of `table` make, its keys being those of a configuration."""
    position = position_of(name, table.pairs(ZONES), law, table, RETARDER)
    position.require_settling()
    return PositionEntry(
        name=name,
        title=title,
        notes=notes,
        law=law,
        position=position,
        profile=profile_of(table),
        entry=entry_law(table),
        friction=Friction(**{key.removeprefix("friction."): table.number(key) for key in FRICTION}),
        sensor=sensor_of(table, SENSOR),
        approach=approach_of(table),
        target_speeds_m_s=table.numbers("targets.exit_speeds_m_s"),
        provenance=table.values,
    )


def approach_of(table: SourcedTable) -> Approach:
    """Where the regulator begins to act; what a cut may be given at the entrance depends on the cut."""
    stage = table.number(INITIAL_STAGE)
    require(stage.is_integer(), f"regulator: initial_stage is {stage:g}; it must be a whole number")
    return Approach(table.number(APPROACH), initial_stage=int(stage))


def profile_of(table: SourcedTable) -> TrackProfile:
    """One grade, or pieces given as pairs (start in m, grade in permille)."""
    grade = table["track.grade_permille"].value
    if isinstance(grade, float):
        return TrackProfile.uniform(grade)
    pieces = table.pairs("track.grade_permille")
    return TrackProfile(tuple(start for start, _ in pieces), tuple(permille for _, permille in pieces))
