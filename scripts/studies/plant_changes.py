"""Plants that differ from the one that a table was tuned for: friction, valves, single values.

The sizes are assumed, like the values they act on; none was measured.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from plant_models import Plant
from synth.retarder.configuration.plant_parameter import nominal_value
from synth.retarder.configuration.plant_values import SLOPES, with_values

AIR: Final = "retarder.pneumatics."


def times(key: str, factor: float) -> Callable[[Plant], Plant]:
    """The value under `key` times `factor`."""

    def change(plant: Plant) -> Plant:
        return with_values(plant, {key: factor * known(plant, key)})

    return change


def friction(mean: float, spread: float) -> Callable[[Plant], Plant]:
    """Friction factor with another mean, and its CV per cut times `spread`.

    ξ_cut and the slope K enter the force as their product: another mean of ξ, its floor in proportion, is another K.
    """

    def change(plant: Plant) -> Plant:
        slope = next(key for key in SLOPES if nominal_value(plant, key) is not None)
        cv = spread * plant.friction.common_cv
        return with_values(plant, {slope: mean * known(plant, slope), "friction.common_cv": cv})

    return change


def aged_valves(plant: Plant) -> Plant:
    """All valve delays doubled, filling and exhausting half as slow again."""
    slower = {"brake_delay_s": 2.0, "touch_delay_s": 2.0, "release_delay_s": 2.0}
    slower |= {"fill_time_constant_s": 1.5, "exhaust_time_constant_s": 1.5}
    return with_values(plant, {AIR + name: factor * known(plant, AIR + name) for name, factor in slower.items()})


def known(plant: Plant, key: str) -> float:
    """The value of `plant` under `key`, which it has."""
    value = nominal_value(plant, key)
    assert value is not None, key
    return value
