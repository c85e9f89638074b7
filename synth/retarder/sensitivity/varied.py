"""The numbers of a plant that nobody at the yard has measured, and how far each may be from what is assumed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final

from plant_models import Plant
from plant_models.library.sourced_value import SET_BY_USER
from synth.retarder.configuration.cut_class import CutClass
from synth.retarder.configuration.plant_parameter import Parameter, parameters, sensible_range
from synth.retarder.configuration.resolved_config import ResolvedConfig

MASS: Final = "cut.mass_t"

NEVER_VARIED: Final = {
    "retarder.stage_pressures_kpa": "read at a gauge; the library has no range for all of them together",
    "retarder.pneumatics.closing_delay_s": "with a narrow dead band the stages would hunt, which the model refuses",
}
"""Keys that are held although the library has a range for them, and why."""


def varied_parameters(
    config: ResolvedConfig, cut_class: CutClass, plant: Plant, target_m_s: float
) -> tuple[Parameter, ...]:
    """Every parameter of `plant` that has a range in the library, uniform from its `low` to its `high`.

    `target_m_s`: the highest that the cut is to leave with. Ranges are those of the library, within what physics and
    use allow, and wide enough to hold the value itself. The mass goes over its category: every cut has its own. What
    the user's configuration sets is held: the yard knows it.
    """
    known = set_by_user(config, cut_class)
    own = {"cut." + value.key.partition(".")[2]: sensible_range(value) for value in cut_class.provenance}
    found = []
    for parameter in parameters(config, cut_class, plant, target_m_s):
        if parameter.key in NEVER_VARIED:
            continue
        span = parameter.sensible or own.get(parameter.key)
        if parameter.key == MASS:
            span = parameter.low, parameter.high
        if parameter.key in known:
            span = parameter.nominal, parameter.nominal
        if span is not None:
            found.append(within_limits(parameter, span))
    return tuple(found)


def within_limits(parameter: Parameter, span: tuple[float, float]) -> Parameter:
    """`parameter` over `span` as far as its limits allow."""
    nominal = parameter.nominal
    low, high = max(min(span[0], nominal), parameter.low), min(max(span[1], nominal), parameter.high)
    return replace(parameter, low=low, high=high)


def set_by_user(config: ResolvedConfig, cut_class: CutClass) -> frozenset[str]:
    """Keys that the user's configuration sets, but the mass of a class, which only says which category it is."""
    retarder = (value.key for value in config.retarder.provenance if value.source == SET_BY_USER)
    cut = ("cut." + v.key.partition(".")[2] for v in cut_class.provenance if v.source == SET_BY_USER)
    return frozenset((*retarder, *cut)) - {MASS}


def moving(classes: Sequence[Sequence[Parameter]]) -> tuple[str, ...]:
    """Keys that are not held in all classes, in the order of the first class."""
    free = {each.key for varied in classes for each in varied if each.high > each.low}
    return tuple(each.key for each in classes[0] if each.key in free)


def values_at(
    varied: Mapping[str, Parameter], keys: Sequence[str], row: Sequence[float]
) -> Iterator[tuple[str, float]]:
    """(key, value) at the point `row` of the unit cube; its numbers belong to `keys`."""
    for key, u in zip(keys, row, strict=True):
        if varied[key].high > varied[key].low:  # so that a number that is held keeps every bit
            yield key, varied[key].low + (varied[key].high - varied[key].low) * u
