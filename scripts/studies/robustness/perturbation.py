"""A perturbation: what differs from the plant that a table was tuned for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from plant_models import Plant
from synth.retarder.configuration.plant_parameter import Parameter
from synth.retarder.configuration.plant_values import STAGE_PRESSURES, changed_position, with_values


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
