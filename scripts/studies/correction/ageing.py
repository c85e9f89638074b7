"""What changes from pass to pass: friction that falls, a speed sensor that creeps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from plant_models import Plant
from plant_models.frozen_arrays import Floats
from synth.simulation.random_passes import RandomPasses


@dataclass(frozen=True)
class Ageing:
    """How a plant ages over a sequence of passes.

    `age`: passes (n,) of the plant, and how far the ageing is at each, (n,) from 0 to 1 → the passes that then come;
    `exit_bias_m_s`: what the measurement of the exit speed reads too much in the end.
    """

    name: str
    age: Callable[[RandomPasses, Plant, Floats], RandomPasses]
    exit_bias_m_s: float = 0.0


def stays(passes: RandomPasses, plant: Plant, share: Floats) -> RandomPasses:
    """Nothing changes."""
    return passes


@dataclass(frozen=True)
class FrictionFalls:
    """Every friction factor ends at (1 - `fall`) of what it was."""

    fall: float

    def __call__(self, passes: RandomPasses, plant: Plant, share: Floats) -> RandomPasses:
        """Standard normal numbers of the same law that stand for the smaller factors."""
        cv = plant.friction_cv
        factor = plant.friction.cut_factor(passes.cut_z, cv) * (1.0 - self.fall * share)
        return replace(passes, cut_z=(factor - 1.0) / cv)


@dataclass(frozen=True)
class SensorCreeps:
    """The sensor reads `bias_m_s` too much in the end, before it rounds: a shift of its noise."""

    bias_m_s: float

    def __call__(self, passes: RandomPasses, plant: Plant, share: Floats) -> RandomPasses:
        """The passes with shifted noise."""
        shift = (self.bias_m_s / plant.sensor.noise_m_s * share).astype(np.float32)
        return replace(passes, noise_z=passes.noise_z + shift[:, None])


def ageings(fall: float, creep_m_s: float) -> tuple[Ageing, ...]:
    """Those of the study: a plant that stays first."""
    return (
        Ageing("stays", stays),
        Ageing(f"friction falls by {100.0 * fall:g} %", FrictionFalls(fall)),
        Ageing(f"sensor creeps to {creep_m_s:+g} m/s, exits measured by another", SensorCreeps(creep_m_s)),
        Ageing(f"sensor creeps to {creep_m_s:+g} m/s, exits measured by itself", SensorCreeps(creep_m_s), creep_m_s),
    )
