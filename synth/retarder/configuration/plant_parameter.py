"""The parameters of a plant that a table may have been tuned on wrongly, and how far each can be off."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from plant_models import Plant, PressingForce
from plant_models.library import SourcedValue
from synth.retarder.configuration.cut_class import CutClass
from synth.retarder.configuration.plant_values import (
    GRADE,
    RELATIVE,
    SLOPE_BY_AXLES,
    SLOPES,
    STAGE_PRESSURES,
    TOUCH_PRESSURE,
)
from synth.retarder.configuration.resolved_config import ResolvedConfig

NAMES: Final = {
    STAGE_PRESSURES: "stage pressures, all",
    SLOPES[0]: "K: force by pressure (= mean friction)",
    SLOPES[1]: "K: force by pressure and load (= mean friction)",
    TOUCH_PRESSURE: "P0: touch pressure",
    SLOPE_BY_AXLES: "c(n): slope with all axles inside",
    "retarder.pneumatics.supply_pressure_kpa": "supply pressure",
    "retarder.pneumatics.brake_delay_s": "tZ2: supply valve delay",
    "retarder.pneumatics.touch_delay_s": "t00: extra delay up to touch",
    "retarder.pneumatics.release_delay_s": "tZ0: exhaust valve delay",
    "retarder.pneumatics.fill_time_constant_s": "filling time constant",
    "retarder.pneumatics.exhaust_time_constant_s": "exhaust time constant",
    "retarder.pneumatics.dead_band_kpa": "dead band of the stages",
    "retarder.pneumatics.closing_delay_s": "valve closing delay",
    "entry.low_m_s": "lowest entry speed",
    "entry.high_m_s": "highest entry speed",
    "friction.common_cv": "CV of friction, per cut",
    "friction.axle_cv": "CV of friction, per axle",
    "friction.path_std": "std of friction along the path",
    "friction.correlation_length_m": "correlation length of friction",
    "friction.floor": "floor of friction",
    "sensor.noise_m_s": "sensor noise",
    "sensor.sample_period_s": "sampling period",
    "sensor.computing_delay_s": "computing delay",
    GRADE: "grade",
    "cut.mass_t": "mass, within the category",
    "cut.rolling_resistance.mean_n_per_kn": "mean rolling resistance",
    "cut.rolling_resistance.std_n_per_kn": "std of rolling resistance",
}
"""What each parameter is called in tables and pictures, by its key; in this order they are studied."""


@dataclass(frozen=True)
class Parameter:
    """One number of a plant: `key` of the configuration, `nominal` value (1 for the factors of `plant_values`).

    `low`, `high`: limits that physics or use put to it; of one that is varied, the ends of its range, and equal ends
    hold it. `assumed`: nothing citable stands behind it; `sensible`: the library's range, None where it has none for
    this very value.
    """

    key: str
    name: str
    nominal: float
    assumed: bool
    low: float = 0.0
    high: float = math.inf
    sensible: tuple[float, float] | None = None


def parameters(config: ResolvedConfig, cut_class: CutClass, plant: Plant, target_m_s: float) -> tuple[Parameter, ...]:
    """All parameters of `plant`, which is the nominal one of `cut_class`, in the order of `NAMES`."""
    assumed = set(assumed_keys(config, cut_class))
    ranges = {value.key: sensible_range(value) for value in config.retarder.provenance}
    limits = limits_of(cut_class, plant, target_m_s)
    found = []
    for key, name in NAMES.items():
        nominal = nominal_value(plant, key)
        if nominal is None:
            continue
        low, high = limits.get(key, (0.0, math.inf))
        found.append(Parameter(key, name, nominal, key in assumed, low, high, ranges.get(key)))
    return tuple(found)


def sensible_range(value: SourcedValue) -> tuple[float, float] | None:
    """The library's range of a single number; for those of `RELATIVE` as factors on the number."""
    number = value.value[0] if isinstance(value.value, tuple) and len(value.value) == 1 else value.value
    if value.range is None or not isinstance(number, float):
        return None
    if value.key not in RELATIVE:
        return value.range
    return (value.range[0] / number, value.range[1] / number) if number > 0.0 else None


def assumed_keys(config: ResolvedConfig, cut_class: CutClass) -> Iterator[str]:
    """Keys of the assumed values of the configuration, 'cut.' for those of the class."""
    yield from (value.key for value in config.retarder.provenance if value.assumed)
    for value in cut_class.provenance:
        if value.assumed:
            yield "cut." + value.key.partition(".")[2]


def nominal_value(plant: Plant, key: str) -> float | None:
    """The value of `plant` under `key`; None where its force law has none."""
    if key in RELATIVE:
        return 1.0
    force = plant.position.force
    if key == TOUCH_PRESSURE:
        return force.touch_pressure_kpa
    if key in SLOPES:
        pressing = isinstance(force, PressingForce)
        field = "slope_kn_per_kpa_per_pair" if pressing else "slope_kn_per_kpa_per_t"
        return float(getattr(force, field)) if key == SLOPES[0 if pressing else 1] else None
    section, _, field = key.rpartition(".")
    holder = {
        "retarder.pneumatics": plant.position.pneumatics,
        "friction": plant.friction,
        "sensor": plant.sensor,
        "entry": plant.entry,
        "cut": plant.cut,
        "cut.rolling_resistance": plant.resistance,
    }[section]
    return float(getattr(holder, field))


def limits_of(cut_class: CutClass, plant: Plant, target_m_s: float) -> dict[str, tuple[float, float]]:
    """(low, high) of the parameters that cannot go anywhere; a mass stays in its category."""
    return {
        "entry.low_m_s": (target_m_s, plant.entry.high_m_s),
        "entry.high_m_s": (plant.entry.low_m_s, plant.position.max_entry_speed_m_s),
        "cut.mass_t": cut_class.mass_limits_t,
    }
