"""A perturbation: what differs from the plant that a table was tuned for; and named conditions of a retarder in
service: wet or oiled, worn, low on air, half out of service, other cuts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Final

from plant_models import Plant
from scripts.studies.changed_plants import AIR, aged_valves, friction, known, times
from synth.retarder.configuration.plant_values import STAGE_PRESSURES, Parameter, changed_position, with_values


def same_plant(plant: Plant) -> Plant:
    """The nominal plant."""
    return plant


@dataclass(frozen=True)
class Perturbation:
    """`change` makes the true plant of the nominal one; `note` says what was clipped.

    `value`: that of the parameter where one alone is off, 0 elsewhere.
    """

    name: str
    change: Callable[[Plant], Plant] = same_plant
    note: str = ""
    value: float = 0.0


Ends = tuple[Perturbation, Perturbation]
"""One parameter low and high."""


def at_value(plant: Plant, parameter: Parameter, value: float, name: str) -> Perturbation:
    """`parameter` of the nominal `plant` at `value`, all else nominal."""
    values = {parameter.key: value}
    return Perturbation(name, lambda nominal: with_values(nominal, values), reach_note(plant, values), value)


def reach_note(plant: Plant, values: Mapping[str, float]) -> str:
    """How many stages the supply no longer reaches; '' if it reaches all."""
    lowered = stages_out_of_reach(plant, values)
    return f"out of reach of the supply: the top {'stage' if lowered == 1 else f'{lowered} stages'}" if lowered else ""


def stages_out_of_reach(plant: Plant, values: Mapping[str, float]) -> int:
    """How many stages `with_values` lowers because the supply does not reach them."""
    factor = values.get(STAGE_PRESSURES, 1.0)
    reached = changed_position(plant, values).stage_pressures_kpa
    return sum(p < factor * q for p, q in zip(reached, plant.position.stage_pressures_kpa, strict=True))


def sensible_ends(plant: Plant, parameter: Parameter) -> Ends:
    """A parameter at the ends of the sensible range that the library gives; `ValueError` if it gives none."""
    if parameter.sensible is None:
        raise ValueError(f"{parameter.key}: the library gives no sensible range")
    low, high = (min(max(value, parameter.low), parameter.high) for value in parameter.sensible)
    at_low = at_value(plant, parameter, low, f"{parameter.name}: {low:.3g} (nominal {parameter.nominal:.3g})")
    return at_low, at_value(plant, parameter, high, f"{parameter.name}: {high:.3g}")


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
