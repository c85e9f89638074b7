"""Which numbers of a configuration the identified numbers are: the one place that says so."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from plant_models import Plant
from plant_models.motion import braked_axles, mean_braked_axles
from plant_models.retarder import factor_at
from synth.logs import unknowns as asked
from synth.retarder.configuration.resolved_config import ResolvedConfig

FACTORS = asked.FORCE + "slope_factor_by_axles"

OF_INSTRUMENTS = (asked.BIAS, asked.GAUGE_NOISE)
"""Numbers of the log alone: no configuration has them."""


@dataclass(frozen=True)
class ConfiguredNumber:
    """`value` of the configuration's `key` ("cut[0]. …" for a class), which the identified number `by` tells."""

    key: str
    value: float | tuple[float, ...]
    by: str


def configured_numbers(values: Mapping[str, float], config: ResolvedConfig) -> Iterator[ConfiguredNumber]:
    """What the identified numbers `values`, by key, are in `config`.

    Most have its keys. A slope by axles goes into the factors of the force slope; rolling resistance of a category, and
    the spread of all, into the classes.
    """
    for key, value in values.items():
        if key in OF_INSTRUMENTS:
            continue
        if key == asked.SLOPE_BY_AXLES:
            yield ConfiguredNumber(FACTORS, factors_by_axles(config, value), key)
        elif key == asked.RESISTANCE_SPREAD:
            for number, of_class in enumerate(config.cuts):
                std = of_class.resistance.std_n_per_kn
                yield ConfiguredNumber(f"cut[{number}].rolling_resistance.std_n_per_kn", std * value, key)
        elif key.startswith(asked.RESISTANCE):
            for number, of_class in enumerate(config.cuts):
                if of_class.cut.category == key.removeprefix(asked.RESISTANCE):
                    yield ConfiguredNumber(f"cut[{number}].rolling_resistance.mean_n_per_kn", value, key)
        else:
            yield ConfiguredNumber(key, value, key)


def factors_by_axles(config: ResolvedConfig, by_axles: float) -> tuple[float, ...]:
    """c(N) for as many wheel pairs as the classes ever have inside, times 1 + `by_axles` (N − N̄).

    N̄ is the mean over the classes, as in the likelihood (`pass_rows`).
    """
    force = config.retarder.position.force
    old: tuple[float, ...] = getattr(force, "slope_factor_by_axles", (1.0,))
    if by_axles == 0.0:
        return old
    plants = [plant for _, plant in config.plants()]
    middle = float(np.mean([mean_braked_axles(plant.position, plant.cut) for plant in plants]))
    most = max(len(old), *(most_braked_axles(plant) for plant in plants))
    return tuple(factor_at(old, n) * (1.0 + by_axles * (n - middle)) for n in range(1, most + 1))


def most_braked_axles(plant: Plant) -> int:
    """Most wheel pairs of the cut that stand in the retarders at a time."""
    return int(braked_axles(plant.position, plant.cut, np.arange(0.0, plant.exit_m, 0.05)).max())
