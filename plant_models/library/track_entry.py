"""A track of the library: falls and bends from the crest on, its park position, and the measured stretch before it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from plant_models.errors import require
from plant_models.library.data_file import (
    Quantity,
    number,
    numbers,
    pairs,
    parse_toml,
    sourced_table,
    take_string,
    take_strings,
    telling,
)
from plant_models.library.library import TypeFile
from plant_models.library.sourced_value import SourcedTable, SourcedValue, Value
from plant_models.rolling.roll_track import Bend, RollTrack
from plant_models.track_profile import TrackProfile

GRADES: Final = "track.grade_permille"
END: Final = "track.end_m"
PROFILE: Final = {GRADES: Quantity("permille, downhill positive", pairs), END: Quantity("m", number)}
BENDS: Final = {
    "bends.zones_m": Quantity("m", pairs),
    "bends.switches": Quantity("1", numbers),
    "bends.turn_deg": Quantity("degrees", numbers),
}
"""These three may be left out together: a track without switches and curves."""

POSITION: Final = {"position.entrance_m": Quantity("m", number), "position.exit_m": Quantity("m", number)}
STRETCH: Final = {
    "stretch.from_m": Quantity("m", number),
    "stretch.to_m": Quantity("m", number),
    "stretch.speed_mean_m_s": Quantity("m/s", number),
    "stretch.speed_std_m_s": Quantity("m/s", number),
}

KEYS_OF_PLANT: Final = {
    "track profile: grades_permille": GRADES,
    "track profile: starts_m": f"{GRADES}: starts_m",
    "track: starts_m": f"{GRADES}: starts_m",
    "track: end_m": END,
    "bend: from_m": "bends.zones_m: from_m",
    "bend: to_m": "bends.zones_m: to_m",
    "bend: switches": "bends.switches: switches",
    "bend: turn_deg": "bends.turn_deg: turn_deg",
}
"""How the plant's messages begin, and the keys of a track file that this means."""


@dataclass(frozen=True)
class TrackEntry:
    """A track with its park position and what is before it, metres from the crest; keys as in a configuration.

    `position`: name of the library's position that stands there. Cuts leave the bunch position ahead of it with a speed
    of mean `bunch_speed_mean_m_s` and standard deviation `bunch_speed_std_m_s`, and are measured over `stretch_m`.
    """

    name: str
    title: str
    notes: tuple[str, ...]
    position: str
    track: RollTrack
    entrance_m: float
    exit_m: float
    stretch_m: tuple[float, float]
    bunch_speed_mean_m_s: float
    bunch_speed_std_m_s: float
    provenance: tuple[SourcedValue, ...]

    def with_values(self, overrides: Mapping[str, Value]) -> TrackEntry:
        """This entry with the values under some dotted keys replaced by the user's; `PlantError` if they make no track.

        Bends are replaced as a whole: all three of their keys, or none.
        """
        known = {value.key: value for value in self.provenance}
        added = tuple(
            SourcedValue(key, overrides[key], quantity.unit, None, "configuration", "")
            for key, quantity in BENDS.items()
            if key in overrides and key not in known
        )
        kept = {key: value for key, value in overrides.items() if key in known}
        table = SourcedTable((*SourcedTable(self.provenance).replaced(kept).values, *added))
        return entry_of(self.name, self.title, self.notes, self.position, table)

    def without_bends(self) -> TrackEntry:
        """This entry with neither switches nor curves."""
        left = tuple(value for value in self.provenance if value.key not in BENDS)
        return entry_of(self.name, self.title, self.notes, self.position, SourcedTable(left))


def track_from(file: TypeFile) -> TrackEntry:
    """The entry written in `file`; `TypeFileError` names file and key."""
    with telling(file.place, file.text, KEYS_OF_PLANT):
        tree = parse_toml(file.text)
        title, notes, position = (
            take_string(tree, "title"),
            take_strings(tree, "notes"),
            take_string(tree, "park_position"),
        )
        table = sourced_table(tree, schema_of(tree), file.origin)
        return entry_of(file.name, title, notes, position, table)


def schema_of(tree: Mapping[str, Any]) -> dict[str, Quantity]:
    """Every key of a track file, those of bends only where the file has some."""
    bends = BENDS if "bends" in tree else {}
    return {**PROFILE, **bends, **POSITION, **STRETCH}


def entry_of(name: str, title: str, notes: tuple[str, ...], position: str, table: SourcedTable) -> TrackEntry:
    """The values that the numbers of `table` make."""
    pieces = table.pairs(GRADES)
    profile = TrackProfile(tuple(start for start, _ in pieces), tuple(grade for _, grade in pieces))
    return TrackEntry(
        name=name,
        title=title,
        notes=notes,
        position=position,
        track=RollTrack(profile, table.number(END), bends_of(table)),
        entrance_m=table.number("position.entrance_m"),
        exit_m=table.number("position.exit_m"),
        stretch_m=(table.number("stretch.from_m"), table.number("stretch.to_m")),
        bunch_speed_mean_m_s=table.number("stretch.speed_mean_m_s"),
        bunch_speed_std_m_s=table.number("stretch.speed_std_m_s"),
        provenance=table.values,
    )


def bends_of(table: SourcedTable) -> tuple[Bend, ...]:
    """Switches and curves in the order of the track; `PlantError` where the three lists are not of one length."""
    if all(value.key not in BENDS for value in table.values):
        return ()
    zones, switches, turns = (
        table.pairs("bends.zones_m"),
        table.numbers("bends.switches"),
        table.numbers("bends.turn_deg"),
    )
    require(
        len(zones) == len(switches) == len(turns),
        f"bends.zones_m has {len(zones)} entries, bends.switches {len(switches)} and bends.turn_deg {len(turns)}; give "
        "one of each for every bend",
    )
    for count in switches:
        require(count.is_integer(), f"bends.switches holds {count:g}; it must be whole numbers")
    return tuple(
        Bend(begins, ends, int(count), turn) for (begins, ends), count, turn in zip(zones, switches, turns, strict=True)
    )
