"""The cut class that a table for point sensors is for, and its sensors, from a configuration."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from plant_models import Approach, Plant, PointSensors, every_axle, first_axle
from synth.frame.input_error import InputError
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.highest_stage import highest_stage
from synth.retarder.validation.revalidation import alike, numbers
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.sensor_layout import DecidesOn, SensorLayout


@dataclass(frozen=True)
class PassageClass:
    """A cut class by its label, its plant with the approach of a table, and the sensors of that table."""

    label: str
    plant: Plant
    sensors: PointSensors


def passage_class(table: PassageTable, config: ResolvedConfig, source: str) -> PassageClass:
    """The class of `config` that `table` is for; `source` is what a message calls the configuration.

    The approach is that of the table. So are the sensors where the configuration has none; where it has, they must
    stand as in the table, and measure as the configuration says. Of several classes that fit, the one whose label
    begins the table's id. `InputError` names what differs in the nearest.
    """
    plants = config.plants()
    here = sensors_of(table.sensors)
    if config.sensors is not None:
        require_same_places(here, config.sensors.sensors, f"{source}: the sensors of the table {table.id}")
        here = config.sensors.sensors
    apart = [tuple(differences(table, plant)) for _, plant in plants]
    fitting = [plants[place] for place, found in enumerate(apart) if not found]
    named = [each for each in fitting if table.id.startswith(f"{each[0]}-to-")]
    if len(named or fitting) == 1:
        label, plant = (named or fitting)[0]
        length, gate = table.approach.length_m, table.approach.entrance_stage
        return PassageClass(label, replace(plant, approach=Approach(length, gate, table.initial_stage)), here)
    if fitting:
        labels = ", ".join(label for label, _ in fitting)
        raise InputError(
            f"{source}: the classes {labels} all fit the table {table.id}; leave the one it was made for, by --config"
        )
    nearest = min(range(len(plants)), key=lambda place: len(apart[place]))
    raise InputError(
        f"{source}: no cut class fits the table {table.id}; the nearest, {plants[nearest][0]}, differs in "
        f"{' and '.join(apart[nearest])}; give the configuration that the table was made from by --config"
    )


def differences(table: PassageTable, plant: Plant) -> Iterator[str]:
    """What of the plant is not what the table was made for, 'key (plant's value, in the table …)'."""
    position, cut, top = plant.position, plant.cut, len(table.pressure_kpa) - 1
    pairs = (
        ("retarder.zones_m", [x for zone in position.zones_m for x in zone],
         [x for zone in table.retarder.zones_m for x in zone]),
        ("retarder.stage_pressures_kpa", position.stage_pressures_kpa[: top + 1], table.pressure_kpa),
        ("retarder.dead_band_kpa", [position.pneumatics.dead_band_kpa], [table.retarder.dead_band_kpa]),
        ("cut.mass_t", [cut.mass_t], [table.cut.mass_t]),
        ("cut.axle_offsets_m", cut.axle_offsets_m, table.cut.axle_offsets_m),
    )  # fmt: skip
    for key, ours, theirs in pairs:
        if len(ours) != len(theirs) or not all(map(alike, ours, theirs)):
            yield f"{key} ({numbers(ours)}, in the table {numbers(theirs)})"
    if highest_stage(table) > plant.top_stage:
        yield f"the highest stage allowed ({plant.top_stage}, in the table {highest_stage(table)})"
    if table.approach.entrance_stage != plant.entrance_stage:
        yield f"cut.entrance_stage ({plant.entrance_stage}, in the table {table.approach.entrance_stage})"
    if cut.category != table.cut.category:
        yield f"cut.category ({cut.category}, in the table {table.cut.category})"


def require_same_places(ours: PointSensors, theirs: PointSensors, what: str) -> None:
    """`InputError` that begins with `what` unless both stand and decide alike, with bases of one length."""
    pairs = (
        ("sensors.path_m", ours.path_m, theirs.path_m),
        ("sensors.base_m", (ours.base_m,), (theirs.base_m,)),
    )
    for key, one, other in pairs:
        if len(one) != len(other) or not all(map(alike, one, other)):
            raise InputError(
                f"{what} are not those of the configuration: {key} is {numbers(other)} there, in the table "
                f"{numbers(one)}; give the configuration that the table was made from by --config, or one without "
                "[sensors]"
            )
    if ours.axles is not theirs.axles:
        raise InputError(
            f"{what} are not those of the configuration: sensors.decides_on differs; give the configuration that the "
            "table was made from by --config, or one without [sensors]"
        )


def sensors_of(layout: SensorLayout) -> PointSensors:
    """The sensors that a table tells, as a plant has them."""
    return PointSensors(
        layout.path_m, layout.base_m, layout.base_tolerance, layout.timer_noise_s, layout.timer_resolution_s,
        layout.computing_delay_s, layout.scan_period_s,
        axles=every_axle if layout.decides_on is DecidesOn.EVERY_AXLE else first_axle,
    )  # fmt: skip
