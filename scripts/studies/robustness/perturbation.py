"""A perturbation: what differs from the plant that a table was tuned for, and what the sensor does wrong."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from plant_models import Plant
from scripts.studies.robustness.sensor_fault import SensorFault, no_fault
from synth.configuration.plant_parameter import Parameter
from synth.configuration.plant_values import stages_out_of_reach, with_values


def same_plant(plant: Plant) -> Plant:
    """The nominal plant."""
    return plant


@dataclass(frozen=True)
class Perturbation:
    """`change` makes the true plant of the nominal one; `fault` acts on the readings; `note` says what was clipped.

    `value`: that of the parameter where one alone is off, 0 elsewhere.
    """

    name: str
    change: Callable[[Plant], Plant] = same_plant
    fault: SensorFault = no_fault
    note: str = ""
    value: float = 0.0


Ends = tuple[Perturbation, Perturbation]
"""One parameter low and high."""


def at_value(plant: Plant, parameter: Parameter, value: float, name: str, remark: str = "") -> Perturbation:
    """`parameter` of the nominal `plant` at `value`, all else nominal."""
    values = {parameter.key: value}
    notes = [remark, reach_note(plant, values)]
    note = "; ".join(filter(None, notes))
    return Perturbation(name, lambda nominal: with_values(nominal, values), note=note, value=value)


def reach_note(plant: Plant, values: Mapping[str, float]) -> str:
    """How many stages the supply no longer reaches; '' if it reaches all."""
    lowered = stages_out_of_reach(plant, values)
    return f"out of reach of the supply: the top {'stage' if lowered == 1 else f'{lowered} stages'}" if lowered else ""


def one_off(plant: Plant, parameter: Parameter, relative: float) -> Perturbation:
    """`parameter` of the nominal `plant` off by `relative`, clipped to its limits."""
    name = f"{parameter.name} {100.0 * relative:+.0f} %"
    return at_value(plant, parameter, parameter.at(relative), name, parameter.note(relative))


def ends_by(relative: float) -> Callable[[Plant, Parameter], Ends]:
    """Every parameter at −`relative` and +`relative`."""

    def ends(plant: Plant, parameter: Parameter) -> Ends:
        return one_off(plant, parameter, -relative), one_off(plant, parameter, relative)

    return ends


def sensible_ends(plant: Plant, parameter: Parameter) -> Ends:
    """A parameter at the ends of the sensible range that the library gives; `ValueError` if it gives none."""
    if parameter.sensible is None:
        raise ValueError(f"{parameter.key}: the library gives no sensible range")
    low, high = (min(max(value, parameter.low), parameter.high) for value in parameter.sensible)
    at_low = at_value(plant, parameter, low, f"{parameter.name}: {low:.3g} (nominal {parameter.nominal:.3g})")
    return at_low, at_value(plant, parameter, high, f"{parameter.name}: {high:.3g}")


def all_off(parameters: Sequence[Parameter], relative: Sequence[float]) -> Perturbation:
    """Every parameter off by its own `relative`; those that are nominally 0 stay so."""
    values = {p.key: p.at(r) for p, r in zip(parameters, relative, strict=True) if p.nominal != 0.0}
    return Perturbation("all parameters", lambda plant: with_values(plant, values))
