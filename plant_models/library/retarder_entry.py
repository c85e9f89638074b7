"""A retarder position of the library: the plant values of its type and place, each number with its origin."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from plant_models.errors import PlantError, require
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
)
from plant_models.library.near_miss import near_miss
from plant_models.library.sourced_value import SourcedTable, SourcedValue, Value
from plant_models.pneumatics import Pneumatics
from plant_models.retarder import ForceLaw, PressingForce, RetarderPosition, WeightForce
from plant_models.speed_sensor import DopplerSensor
from plant_models.track_profile import TrackProfile

FORCE = "retarder.force."
PNEUMATICS = "retarder.pneumatics."


@dataclass(frozen=True)
class LawInLibrary:
    """A force law as files name it: the key of its slope, the slope's unit, and its constructor."""

    slope_key: str
    slope_unit: str
    build: Callable[[float, float, tuple[float, ...]], ForceLaw]


FORCE_LAWS: Mapping[str, LawInLibrary] = MappingProxyType(
    {
        "pressing": LawInLibrary(FORCE + "slope_kn_per_kpa", "kN/kPa per wheel pair", PressingForce),
        "weight": LawInLibrary(FORCE + "slope_kn_per_kpa_per_t", "kN/kPa per tonne of axle load", WeightForce),
    }
)


def retarder_schema(law: str) -> dict[str, Quantity]:
    """Every key of a retarder file with the force law `law`; the configuration uses the same keys."""
    force = FORCE_LAWS[law]
    return {
        "retarder.zones_m": Quantity("m", pairs),
        "retarder.stage_pressures_kpa": Quantity("kPa gauge", numbers),
        "retarder.max_entry_speed_m_s": Quantity("m/s", number),
        force.slope_key: Quantity(force.slope_unit, number),
        FORCE + "touch_pressure_kpa": Quantity("kPa gauge", number),
        FORCE + "slope_factor_by_axles": Quantity("1", numbers),
        PNEUMATICS + "supply_pressure_kpa": Quantity("kPa gauge", number),
        PNEUMATICS + "exhaust_pressure_kpa": Quantity("kPa gauge", number),
        PNEUMATICS + "brake_delay_s": Quantity("s", number),
        PNEUMATICS + "touch_delay_s": Quantity("s", number),
        PNEUMATICS + "release_delay_s": Quantity("s", number),
        PNEUMATICS + "fill_time_constant_s": Quantity("s", number),
        PNEUMATICS + "exhaust_time_constant_s": Quantity("s", number),
        PNEUMATICS + "dead_band_kpa": Quantity("kPa", number),
        PNEUMATICS + "closing_delay_s": Quantity("s", number),
        "track.grade_permille": Quantity("permille, downhill positive", number_or_pairs),
        "entry.low_m_s": Quantity("m/s", number),
        "entry.high_m_s": Quantity("m/s", number),
        "friction.common_cv": Quantity("1", number),
        "friction.axle_cv": Quantity("1", number),
        "friction.path_std": Quantity("1", number),
        "friction.correlation_length_m": Quantity("m", number),
        "friction.floor": Quantity("1", number),
        "sensor.noise_m_s": Quantity("m/s", number),
        "sensor.resolution_m_s": Quantity("m/s", number),
        "sensor.sample_period_s": Quantity("s", number),
        "sensor.computing_delay_s": Quantity("s", number),
        "targets.exit_speeds_m_s": Quantity("m/s", numbers),
    }


@dataclass(frozen=True)
class RetarderEntry:
    """A position, its usual surroundings (grade, entry speeds, friction, sensor, exit speeds) and their origin.

    `entry_speed_m_s`: lowest and highest entry speed. `provenance`: every number behind the other fields.
    """

    name: str
    title: str
    notes: tuple[str, ...]
    law: str
    position: RetarderPosition
    profile: TrackProfile
    entry_speed_m_s: tuple[float, float]
    friction: Friction
    sensor: DopplerSensor
    target_speeds_m_s: tuple[float, ...]
    provenance: tuple[SourcedValue, ...]

    def with_values(self, overrides: Mapping[str, Value]) -> RetarderEntry:
        """This entry with the values under some dotted keys replaced by the user's.

        Raises `PlantError` for a key that the entry has not, and for a value that the plant refuses.
        """
        known = [v.key for v in self.provenance]
        for key in overrides:
            require(
                key in known,
                f"{key} is {overrides[key]!r}; the {self.law} force law of {self.name} has no such value: "
                f"{near_miss(key, known)}",
            )
        table = SourcedTable(self.provenance).replaced(overrides)
        return entry_of(self.name, self.title, self.notes, self.law, table)


def retarder_from_toml(text: str, name: str) -> RetarderEntry:
    """The entry written in `text`, the content of retarders/`name`.toml; `PlantError` names file and key."""
    file = f"retarders/{name}.toml"
    tree = parse_toml(text, file)
    title, law = take_string(tree, "title", file), take_string(tree, "law", file)
    notes = take_strings(tree, "notes", file)
    require(law in FORCE_LAWS, f"{file}: law is {law!r}; {near_miss(law, FORCE_LAWS)}")
    table = sourced_table(tree, retarder_schema(law), file)
    try:
        return entry_of(name, title, notes, law, table)
    except PlantError as error:
        raise PlantError(f"{file}: {error}") from None


def entry_of(name: str, title: str, notes: tuple[str, ...], law: str, table: SourcedTable) -> RetarderEntry:
    """The plant values that the table's numbers make."""
    force = FORCE_LAWS[law]
    position = RetarderPosition(
        name=name,
        zones_m=table.pairs("retarder.zones_m"),
        stage_pressures_kpa=table.numbers("retarder.stage_pressures_kpa"),
        force=force.build(
            table.number(force.slope_key),
            table.number(FORCE + "touch_pressure_kpa"),
            table.numbers(FORCE + "slope_factor_by_axles"),
        ),
        pneumatics=Pneumatics(
            supply_pressure_kpa=table.number(PNEUMATICS + "supply_pressure_kpa"),
            exhaust_pressure_kpa=table.number(PNEUMATICS + "exhaust_pressure_kpa"),
            brake_delay_s=table.number(PNEUMATICS + "brake_delay_s"),
            touch_delay_s=table.number(PNEUMATICS + "touch_delay_s"),
            release_delay_s=table.number(PNEUMATICS + "release_delay_s"),
            fill_time_constant_s=table.number(PNEUMATICS + "fill_time_constant_s"),
            exhaust_time_constant_s=table.number(PNEUMATICS + "exhaust_time_constant_s"),
            dead_band_kpa=table.number(PNEUMATICS + "dead_band_kpa"),
            closing_delay_s=table.number(PNEUMATICS + "closing_delay_s"),
        ),
        max_entry_speed_m_s=table.number("retarder.max_entry_speed_m_s"),
    )
    return RetarderEntry(
        name=name,
        title=title,
        notes=notes,
        law=law,
        position=position,
        profile=profile_of(table),
        entry_speed_m_s=(table.number("entry.low_m_s"), table.number("entry.high_m_s")),
        friction=Friction(
            common_cv=table.number("friction.common_cv"),
            axle_cv=table.number("friction.axle_cv"),
            path_std=table.number("friction.path_std"),
            correlation_length_m=table.number("friction.correlation_length_m"),
            floor=table.number("friction.floor"),
        ),
        sensor=DopplerSensor(
            noise_m_s=table.number("sensor.noise_m_s"),
            resolution_m_s=table.number("sensor.resolution_m_s"),
            sample_period_s=table.number("sensor.sample_period_s"),
            computing_delay_s=table.number("sensor.computing_delay_s"),
        ),
        target_speeds_m_s=table.numbers("targets.exit_speeds_m_s"),
        provenance=table.values,
    )


def profile_of(table: SourcedTable) -> TrackProfile:
    """One grade, or pieces given as pairs (start in m, grade in permille)."""
    grade = table["track.grade_permille"].value
    if isinstance(grade, float):
        return TrackProfile.uniform(grade)
    pieces = table.pairs("track.grade_permille")
    return TrackProfile(tuple(start for start, _ in pieces), tuple(permille for _, permille in pieces))
