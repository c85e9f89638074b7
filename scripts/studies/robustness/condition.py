"""Named conditions of a retarder in service: wet or oiled, worn, low on air, half out of service, other cuts."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Final

from plant_models import Plant
from scripts.studies.plant_changes import AIR, aged_valves, friction, known, times
from scripts.studies.robustness.perturbation import Perturbation, reach_note
from synth.retarder.configuration.plant_parameter import Parameter
from synth.retarder.configuration.plant_values import with_values

SLIVER_M: Final = 1e-6
"""Length of what is left of a zone out of service: it keeps entrance and exit in their places and does no work."""


def conditions(plant: Plant, mass: Parameter) -> tuple[Perturbation, ...]:
    """The named conditions that the nominal `plant` can be in; `mass`: lightest and heaviest cut of the category."""
    return (
        Perturbation("wet: friction × 0.7, CV × 4/3", friction(0.7, 4.0 / 3.0)),
        Perturbation("oiled: friction × 0.5, CV × 5/3", friction(0.5, 5.0 / 3.0)),
        Perturbation("new bars: friction × 1.15", friction(1.15, 1.0)),
        Perturbation("aged valves: delays × 2, time constants × 1.5", aged_valves),
        low_on_air(plant, 0.9, "supply pressure −10 %"),
        low_on_air(plant, 0.8, "supply pressure −20 %"),
        Perturbation("dead band × 2", times(AIR + "dead_band_kpa", 2.0)),
        Perturbation("stage pressures −20 kPa", shifted_stages(-20.0)),
        Perturbation("stage pressures +20 kPa", shifted_stages(20.0)),
        *half_in_service(plant),
        Perturbation(f"lightest cut of the category, {mass.low:g} t", mass_of(mass.low)),
        Perturbation(f"heaviest cut of the category, {mass.high:g} t", mass_of(mass.high)),
    )


def half_in_service(plant: Plant) -> Iterator[Perturbation]:
    """One retarder of several does not brake."""
    if len(plant.position.zones_m) > 1:
        yield Perturbation("first retarder out of service", out_of_service(0))
        yield Perturbation("last retarder out of service", out_of_service(-1))


def low_on_air(plant: Plant, factor: float, name: str) -> Perturbation:
    """Supply pressure times `factor`."""
    key = AIR + "supply_pressure_kpa"
    return Perturbation(name, times(key, factor), note=reach_note(plant, {key: factor * known(plant, key)}))


def shifted_stages(shift_kpa: float) -> Callable[[Plant], Plant]:
    """All stage pressures but the released one moved by `shift_kpa`."""

    def change(plant: Plant) -> Plant:
        released, *braking = plant.position.stage_pressures_kpa
        moved = (released, *(pressure + shift_kpa for pressure in braking))
        return replace(plant, position=replace(plant.position, stage_pressures_kpa=moved))

    return change


def out_of_service(zone: int) -> Callable[[Plant], Plant]:
    """Zone number `zone` does not brake; the path to the exit and the controller stay as they are."""

    def change(plant: Plant) -> Plant:
        zones = list(plant.position.zones_m)
        if len(zones) < 2:
            raise ValueError(f"robustness: {plant.position.name} has one retarder; none can be out of service")
        start, end = zones[zone]
        zones[zone] = (start, start + SLIVER_M) if start == 0.0 else (end - SLIVER_M, end)
        return replace(plant, position=replace(plant.position, zones_m=tuple(zones)))

    return change


def mass_of(mass_t: float) -> Callable[[Plant], Plant]:
    """A cut of another mass under the table of its category."""

    def change(plant: Plant) -> Plant:
        return with_values(plant, {"cut.mass_t": mass_t})

    return change
