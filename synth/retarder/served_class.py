"""The cut class of a configuration that a table is for, and the point sensors that it decides on."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final, overload

import numpy as np

from plant_models import Approach, Plant, PointSensors, every_axle, first_axle
from plant_models.library.position_entry import APPROACH
from synth.frame.faults import InputError
from synth.retarder.configuration.resolved_config import ResolvedConfig
from tuning_tables.document import StageTable
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.sensor_layout import DecidesOn, SensorLayout


def highest_stage(table: PassageTable) -> int:
    """The highest stage that the table ever asks for from a lower one; it has rows for those above, too."""
    top = len(table.pressure_kpa) - 1
    raised = [
        wanted + 1
        for stage in range(top)
        for wanted in range(stage, top)
        if np.isfinite(table.switching_m_s[:, stage, wanted]).any()
    ]
    return max([table.initial_stage, *raised])


LENGTH_TOLERANCE = 1e-6
"""Relative, for lengths, masses and pressures that must be the same."""

GIVE: Final = "give the configuration that the table was made from by --config"


@dataclass(frozen=True)
class ServedClass:
    """The cut class that a table is for, by its label, and its plant."""

    label: str
    plant: Plant


@dataclass(frozen=True)
class PassageClass(ServedClass):
    """That of a table for point sensors: the sensors, and the plant with the approach of the table."""

    sensors: PointSensors


@overload
def served_class(table: PassageTable, config: ResolvedConfig, source: str) -> PassageClass: ...
@overload
def served_class(table: StageTable, config: ResolvedConfig, source: str) -> ServedClass: ...
def served_class(table: StageTable, config: ResolvedConfig, source: str) -> ServedClass:
    """The class of `config` that `table` is for; `source` is what a message calls the configuration.

    As `plant_for`. Point sensors are those of the table where the configuration has none; where it has, they must stand
    as in the table, and measure as the configuration says.
    """
    if not isinstance(table, PassageTable):
        return ServedClass(*plant_for(table, config, source))
    sensors = sensors_of(table.sensors)
    if config.sensors is not None:
        require_same_places(sensors, config.sensors.sensors, f"{source}: the sensors of the table {table.id}")
        sensors = config.sensors.sensors
    label, plant = plant_for(table, config, source)
    approach = Approach(table.approach.length_m, table.approach.entrance_stage, table.initial_stage)
    return PassageClass(label, replace(plant, approach=approach), sensors)


def plant_for(table: StageTable, config: ResolvedConfig, source: str) -> tuple[str, Plant]:
    """(label, plant) of the cut class that `table` is for; `source` is what a message calls the configuration.

    Of several that fit, the one whose label begins the table's id. `InputError` names what differs in the nearest.
    """
    plants = config.plants()
    apart = [tuple(differences(table, plant)) for _, plant in plants]
    fitting = [place for place, found in enumerate(apart) if not found]
    named = [place for place in fitting if table.id.startswith(f"{plants[place][0]}-to-")]
    if len(named or fitting) == 1:
        return plants[(named or fitting)[0]]
    if fitting:
        labels = ", ".join(plants[place][0] for place in fitting)
        raise InputError(
            f"{source}: the classes {labels} all fit the table {table.id}; leave the one it was made for, by --config"
        )
    nearest = min(range(len(plants)), key=lambda place: len(apart[place]))
    raise InputError(
        f"{source}: no cut class fits the table {table.id}; the nearest, {plants[nearest][0]}, differs in "
        f"{' and '.join(apart[nearest])}; {remedy(table, apart[nearest])}"
    )


def remedy(table: StageTable, apart: Sequence[str]) -> str:
    """What to do where the nearest class differs in `apart`. A configuration of before names no approach, so it gets
    the one of the library's position, which tables of before do not have."""
    if table.approach is None and len(apart) == 1 and apart[0].startswith(APPROACH):
        return f"{GIVE}, with {APPROACH} = 0 in it if it names none"
    return GIVE


def differences(table: StageTable, plant: Plant) -> Iterator[str]:
    """What of the plant is not what the table was made for, 'key (plant's value, in the table …)'."""
    position, cut = plant.position, plant.cut
    pairs: tuple[tuple[str, Sequence[float], Sequence[float]], ...] = (
        ("retarder.zones_m", [x for zone in position.zones_m for x in zone],
         [x for zone in table.retarder.zones_m for x in zone]),
        ("retarder.dead_band_kpa", [position.pneumatics.dead_band_kpa], [table.retarder.dead_band_kpa]),
        ("cut.mass_t", [cut.mass_t], [table.cut.mass_t]),
        ("cut.axle_offsets_m", cut.axle_offsets_m, table.cut.axle_offsets_m),
        *stages_and_approach(table, plant),
    )  # fmt: skip
    for key, ours, theirs in pairs:
        if len(ours) != len(theirs) or not all(map(alike, ours, theirs)):
            yield f"{key} ({numbers(ours)}, in the table {numbers(theirs)})"
    if table.approach and table.approach.entrance_stage != plant.entrance_stage:
        yield f"cut.entrance_stage ({plant.entrance_stage}, in the table {table.approach.entrance_stage})"
    if cut.category != table.cut.category:
        yield f"cut.category ({cut.category}, in the table {table.cut.category})"


def stages_and_approach(table: StageTable, plant: Plant) -> Iterator[tuple[str, Sequence[float], Sequence[float]]]:
    """Pairs of what a table with lines and one for point sensors tell otherwise.

    The latter begins where its first sensor stands, and may be for a class that is allowed more stages.
    """
    pressures_kpa = plant.position.stage_pressures_kpa
    if isinstance(table, PassageTable):
        top = highest_stage(table)
        yield "retarder.stage_pressures_kpa", pressures_kpa[: len(table.pressure_kpa)], table.pressure_kpa
        if top > plant.top_stage:
            yield "the highest stage allowed", [plant.top_stage], [top]
        return
    yield "retarder.stage_pressures_kpa", pressures_kpa, [stage.pressure_kpa for stage in table.stages]
    yield APPROACH, [plant.approach.length_m], [table.approach.length_m if table.approach else 0.0]
    yield "the highest stage allowed", [plant.top_stage], [table.highest_raised]


def require_same_places(ours: PointSensors, theirs: PointSensors, what: str) -> None:
    """`InputError` that begins with `what` unless both stand and decide alike, with bases of one length."""
    pairs = (
        ("sensors.path_m", ours.path_m, theirs.path_m),
        ("sensors.base_m", (ours.base_m,), (theirs.base_m,)),
    )
    advice = f"{GIVE}, or one without [sensors]"
    for key, one, other in pairs:
        if len(one) != len(other) or not all(map(alike, one, other)):
            raise InputError(
                f"{what} are not those of the configuration: {key} is {numbers(other)} there, in the table "
                f"{numbers(one)}; {advice}"
            )
    if ours.axles is not theirs.axles:
        raise InputError(f"{what} are not those of the configuration: sensors.decides_on differs; {advice}")


def sensors_of(layout: SensorLayout) -> PointSensors:
    """The sensors that a table tells, as a plant has them."""
    return PointSensors(
        layout.path_m, layout.base_m, layout.base_tolerance, layout.timer_noise_s, layout.timer_resolution_s,
        layout.computing_delay_s, layout.scan_period_s,
        axles=every_axle if layout.decides_on is DecidesOn.EVERY_AXLE else first_axle,
    )  # fmt: skip


def alike(one: float, other: float) -> bool:
    """Equal but for rounding."""
    return math.isclose(one, other, rel_tol=LENGTH_TOLERANCE, abs_tol=LENGTH_TOLERANCE)


def numbers(values: Sequence[float]) -> str:
    """Numbers with commas."""
    return ", ".join(f"{value:g}" for value in values)
