"""A plant with other values under some keys of the configuration, all put in at once; and the parameters that a table
may have been tuned on wrongly, and how far each can be off.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

from plant_models import EntryLaw, Plant, Pneumatics, PressingForce, RetarderPosition, TrackProfile, WeightForce
from plant_models.library import SourcedValue
from synth.retarder.configuration.cut_class import CutClass
from synth.retarder.configuration.resolved_config import ResolvedConfig

STAGE_PRESSURES: Final = "retarder.stage_pressures_kpa"
GRADE: Final = "track.grade_permille"
SLOPE_BY_AXLES: Final = "retarder.force.slope_factor_by_axles"
SLOPES: Final = ("retarder.force.slope_kn_per_kpa", "retarder.force.slope_kn_per_kpa_per_t")
TOUCH_PRESSURE: Final = "retarder.force.touch_pressure_kpa"
RELATIVE: Final = (STAGE_PRESSURES, GRADE, SLOPE_BY_AXLES)
"""Keys whose value here is a factor: on all stage pressures; on all grades; c(n) with all n axles of the cut inside,
c being 1 + (c(n) − 1)·(j − 1)/(n − 1) times the plant's own for j axles."""

SECTIONS: Final = ("retarder.pneumatics", "friction", "sensor", "cut", "cut.rolling_resistance", "entry")

NEARLY_SUPPLY: Final = 0.99
"""A stage that the supply cannot reach rests at this share of the supply pressure; 4.6 time constants of filling."""


def with_values(plant: Plant, values: Mapping[str, float]) -> Plant:
    """`plant` with `values` in SI under keys of the configuration ('cut.' for 'cut[i].'); no key: the same values.

    Stages that the supply no longer reaches are lowered, see `within_supply`. The highest entry speed is at least the
    lowest. Raises `ValueError` for a key that is not known here, `PlantError` for a value that the plant refuses.
    """
    known = {*RELATIVE, *SLOPES, TOUCH_PRESSURE}
    for key in values:
        if key not in known and key.rpartition(".")[0] not in SECTIONS:
            raise ValueError(f"{key}: a plant has no such value")
    cut = replace(plant.cut, **fields_in("cut", values))
    return replace(
        plant,
        position=changed_position(plant, values),
        cut=cut,
        profile=changed_profile(plant.profile, values.get(GRADE, 1.0)),
        friction=replace(plant.friction, **fields_in("friction", values)),
        resistance=replace(plant.resistance, **fields_in("cut.rolling_resistance", values)),
        sensor=replace(plant.sensor, **fields_in("sensor", values)),
        entry=changed_entry(plant.entry, values),
    )


def fields_in(section: str, values: Mapping[str, float]) -> dict[str, Any]:
    """Those of `values` that stand directly in `section`, by the last part of their keys."""
    parts = ((key.rpartition("."), value) for key, value in values.items())
    return {name: value for (head, _, name), value in parts if head == section}


def changed_position(plant: Plant, values: Mapping[str, float]) -> RetarderPosition:
    """The position with another drive, force law and stage pressures."""
    position = plant.position
    air = replace(position.pneumatics, **fields_in("retarder.pneumatics", values))
    factor = values.get(STAGE_PRESSURES, 1.0)
    pressures = within_supply(tuple(factor * p for p in position.stage_pressures_kpa), air)
    force = changed_force(plant, values)
    return replace(position, pneumatics=air, stage_pressures_kpa=pressures, force=force)


def changed_force(plant: Plant, values: Mapping[str, float]) -> PressingForce | WeightForce:
    """The force law with other numbers."""
    force = plant.position.force
    touch = values.get(TOUCH_PRESSURE, force.touch_pressure_kpa)
    if isinstance(force, PressingForce):
        slope = values.get(SLOPES[0], force.slope_kn_per_kpa_per_pair)
        factors = by_axles(force.slope_factor_by_axles, values.get(SLOPE_BY_AXLES, 1.0), plant.cut.axles)
        return PressingForce(slope, touch, factors)
    if isinstance(force, WeightForce):
        slope = values.get(SLOPES[1], force.slope_kn_per_kpa_per_t)
        factors = by_axles(force.slope_factor_by_axles, values.get(SLOPE_BY_AXLES, 1.0), plant.cut.axles)
        return WeightForce(slope, touch, factors)
    raise ValueError(f"plant values: the force law {type(force).__name__} has no numbers that can be changed")


def by_axles(factors: tuple[float, ...], at_all: float, axles: int) -> tuple[float, ...]:
    """c(j) for j = 1 … n, times 1 for one axle, times `at_all` for all `axles`, linear between."""
    if at_all == 1.0 or axles == 1:
        return factors
    known = [factors[min(j, len(factors) - 1)] for j in range(axles)]
    return tuple(c * (1.0 + (at_all - 1.0) * j / (axles - 1)) for j, c in enumerate(known))


def within_supply(pressures_kpa: tuple[float, ...], air: Pneumatics) -> tuple[float, ...]:
    """Stage pressures as they come about: what the supply cannot reach rests just below it.

    The top stage is at most where filling stops at 99 % of the supply; each stage below keeps two half bands and 1 kPa
    under the next, so that the stages stay apart as the regulator needs.
    """
    highest = NEARLY_SUPPLY * air.supply_pressure_kpa + air.dead_band_kpa
    reached: list[float] = []
    for pressure in reversed(pressures_kpa):
        reached.append(min(pressure, highest))
        highest = reached[-1] - 2.0 * air.dead_band_kpa - 1.0
    return tuple(reversed(reached))


def changed_profile(profile: TrackProfile, factor: float) -> TrackProfile:
    """All grades times `factor`."""
    return replace(profile, grades_permille=tuple(factor * grade for grade in profile.grades_permille))


def changed_entry(entry: EntryLaw, values: Mapping[str, float]) -> EntryLaw:
    """Entry speeds; low and high may be moved at once, and must not cross. Other laws than uniform are stretched."""
    fields = fields_in("entry", values)
    if not fields:
        return entry
    low = fields.get("low_m_s", entry.low_m_s)
    return entry.stretched(low, max(low, fields.get("high_m_s", entry.high_m_s)))


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
