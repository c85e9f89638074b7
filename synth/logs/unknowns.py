"""The numbers of a retarder position that measured passes are asked for, with what is known of them before."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from plant_models.frozen_arrays import Floats
from plant_models.library import SourcedValue
from plant_models.pressure_regulator import USUAL_NOISE_KPA
from synth.logs.fitting_passes import FittingPasses

FORCE, PNEUMATICS, FRICTION, SENSOR = "retarder.force.", "retarder.pneumatics.", "friction.", "sensor."
TOUCH_PRESSURE = FORCE + "touch_pressure_kpa"
SLOPE_BY_AXLES = FORCE + "slope_by_axles"
FILL, EXHAUST = PNEUMATICS + "fill_time_constant_s", PNEUMATICS + "exhaust_time_constant_s"
BRAKE_DELAY, TOUCH_DELAY = PNEUMATICS + "brake_delay_s", PNEUMATICS + "touch_delay_s"
RELEASE_DELAY, DEAD_BAND = PNEUMATICS + "release_delay_s", PNEUMATICS + "dead_band_kpa"
COMMON_CV, PATH_STD = FRICTION + "common_cv", FRICTION + "path_std"
CORRELATION_LENGTH = FRICTION + "correlation_length_m"
NOISE, BIAS = SENSOR + "noise_m_s", SENSOR + "bias_m_s"
RESISTANCE, RESISTANCE_SPREAD = "rolling_resistance.mean_n_per_kn ", "rolling_resistance.spread"
"""Of a weight category, whose name follows; and of all: the standard deviation over what was taken before."""
GAUGE_NOISE = "gauge.noise_kpa"

FRICTION_BY_SPEED, FORCE_BY_PRESSURE = "friction.by_speed", "retarder.force.by_pressure"
RESISTANCE_BY_SPEED = "rolling_resistance.by_speed"
"""What the model has not, and is only tested for: relative changes, see `Likelihood.beyond`."""

OF_VALVES = (TOUCH_PRESSURE, FILL, EXHAUST, BRAKE_DELAY, TOUCH_DELAY, RELEASE_DELAY, DEAD_BAND)
"""On these depends the pressure at a time."""

VALVE_TIMES = (FILL, EXHAUST, BRAKE_DELAY, RELEASE_DELAY)

SAME, LOGARITHM = (float, float), (math.log, math.exp)

RANGES: Mapping[str, tuple[float, float, float]] = {
    SLOPE_BY_AXLES: (0.0, -0.1, 0.1),
    BIAS: (0.0, -0.05, 0.05),
    RESISTANCE_SPREAD: (1.0, 0.6, 1.7),
    GAUGE_NOISE: (USUAL_NOISE_KPA, 0.5, 20.0),
}
"""(value, low, high) of numbers that no configuration has."""

LEAST_SHARE = 0.05
"""A sensible range that begins at 0 is taken to begin at this share of its end."""


@dataclass(frozen=True)
class Unknown:
    """One number: its key (as in a configuration where that has it) and unit, and what is known of it before.

    `to_scale`, `from_scale`: the scale on which its law is normal; `mean`, `std` of that law, on the scale. The law is
    wide: half of the sensible range is one standard deviation on either side.
    """

    key: str
    unit: str
    mean: float
    std: float
    to_scale: Callable[[float], float]
    from_scale: Callable[[float], float]

    def value(self, u: float) -> float:
        """The number, `u` standard deviations of what is known before from its mean."""
        return self.from_scale(self.mean + self.std * u)

    def standing(self, value: float) -> float:
        """The `u` of a number."""
        return (self.to_scale(value) - self.mean) / self.std


def positive(key: str, unit: str, value: float, low: float, high: float) -> Unknown:
    """A number above 0."""
    low = max(low, LEAST_SHARE * high)
    middle = value if value > 0.0 else math.sqrt(low * high)
    return Unknown(key, unit, math.log(middle), max(0.5 * math.log(high / low), 0.2), *LOGARITHM)


def any_sign(key: str, unit: str, value: float, low: float, high: float) -> Unknown:
    """A number of either sign."""
    return Unknown(key, unit, value, 0.5 * (high - low), *SAME)


def unknowns_of(passes: FittingPasses, parameters: Sequence[SourcedValue]) -> tuple[Unknown, ...]:
    """All that is asked of `passes`; `parameters` are those of the configuration, with their sensible ranges."""
    known = {value.key: value for value in parameters}
    (slope,) = (key for key in known if key.startswith(FORCE + "slope_kn_per_kpa"))
    return tuple(_asked(passes, known, slope))


def slope_of(unknowns: Sequence[Unknown]) -> str:
    """The key of the force slope, which each law of force names in its own way."""
    return unknowns[0].key


def _asked(passes: FittingPasses, known: Mapping[str, SourcedValue], slope: str) -> Iterator[Unknown]:
    for key in (slope, *OF_VALVES, COMMON_CV, PATH_STD, CORRELATION_LENGTH, NOISE):
        value, span = known[key].value, known[key].range
        assert isinstance(value, float), key
        assert span is not None, key
        yield positive(key, known[key].unit, value, *span)
    yield any_sign(SLOPE_BY_AXLES, "1 a wheel pair", *RANGES[SLOPE_BY_AXLES])
    if passes.log.path_is_independent:
        yield any_sign(BIAS, "m/s", *RANGES[BIAS])
    if passes.log.has_gauge:
        yield positive(GAUGE_NOISE, "kPa", *RANGES[GAUGE_NOISE])
    plants = [passes.plants[number][1] for number in sorted(set(passes.class_of.tolist()))]
    for category, mean in {p.cut.category: p.resistance.mean_n_per_kn for p in plants}.items():
        yield positive(RESISTANCE + category, "N/kN", mean, 0.5 * mean, 2.0 * mean)
    if any(plant.resistance.std_n_per_kn > 0.0 for _, plant in passes.plants):
        yield positive(RESISTANCE_SPREAD, "1", *RANGES[RESISTANCE_SPREAD])


def values_at(unknowns: Sequence[Unknown], u: Floats) -> dict[str, float]:
    """The numbers by key."""
    return {unknown.key: unknown.value(float(x)) for unknown, x in zip(unknowns, u, strict=True)}
