"""The configuration of identified numbers: the same position and cuts, with what measured passes say of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from plant_models import Plant, RollingResistance
from plant_models.library.position_entry import PositionEntry
from plant_models.library.sourced_value import SourcedValue, Value
from plant_models.motion import braked_axles, mean_braked_axles
from plant_models.retarder import factor_at
from synth.configuration.cut_class import CutClass
from synth.configuration.resolved_config import ResolvedConfig
from synth.yard.measured_passes import unknowns as asked
from synth.yard.measured_passes.estimate import Estimate

FACTORS = asked.FORCE + "slope_factor_by_axles"

OF_POSITION = (*asked.OF_VALVES, asked.COMMON_CV, asked.PATH_STD, asked.CORRELATION_LENGTH, asked.NOISE)
"""Besides the force slope; they have the key of a configuration."""


def identified_plants(config: ResolvedConfig, estimate: Estimate) -> ResolvedConfig:
    """`config` with the numbers of `estimate`, each with its origin 'identified from n passes'.

    Raises `PlantError` for numbers that no plant may have.
    """
    return with_identified(config, estimate.values, f"identified from {estimate.passes} passes")


def with_identified(config: ResolvedConfig, values: Mapping[str, float], source: str) -> ResolvedConfig:
    """`config` with the numbers `values` by key, whose origin is called `source`.

    Keys that a configuration has replace what it has. A slope by axles goes into the factors of the force slope,
    resistances into the classes. What belongs to instruments alone, bias and gauge, is no number of a plant. Raises
    `PlantError`.
    """
    slope = next(key for key in values if key.startswith(asked.FORCE + "slope_kn_per_kpa"))
    overrides: dict[str, Value] = {key: values[key] for key in (slope, *OF_POSITION) if key in values}
    overrides[FACTORS] = factors_by_axles(config, values.get(asked.SLOPE_BY_AXLES, 0.0))
    cuts = tuple(identified_class(each, values, source) for each in config.cuts)
    at = sourced(config.retarder.with_values(overrides), overrides, source)
    known = {each.key: each for each in (*at.provenance, *(value for cut in cuts for value in cut.provenance))}
    parameters = tuple(known.get(each.key, each) for each in config.parameters)
    return replace(config, retarder=at, cuts=cuts, parameters=parameters)


def sourced(at: PositionEntry, overrides: Mapping[str, Value], source: str) -> PositionEntry:
    """`at` with the origin of the numbers that were replaced."""
    told = tuple(replace(v, source=source, confidence="") if v.key in overrides else v for v in at.provenance)
    return replace(at, provenance=told)


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


def identified_class(cut: CutClass, values: Mapping[str, float], source: str) -> CutClass:
    """The class with its identified resistance, mean and spread."""
    law, key = cut.resistance, asked.RESISTANCE + cut.cut.category
    spread = values.get(asked.RESISTANCE_SPREAD, 1.0)
    found = RollingResistance(values.get(key, law.mean_n_per_kn), law.std_n_per_kn * spread)
    changed = {
        "mean_n_per_kn": (found.mean_n_per_kn, key in values),
        "std_n_per_kn": (found.std_n_per_kn, asked.RESISTANCE_SPREAD in values),
    }

    def told(value: SourcedValue) -> SourcedValue:
        number, is_new = changed.get(value.key.rpartition(".")[2], (0.0, False))
        return replace(value, value=number, source=source, confidence="") if is_new else value

    return replace(cut, resistance=found, provenance=tuple(told(value) for value in cut.provenance))
