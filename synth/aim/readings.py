"""What can be measured of a cut before its exit speed is set, and how well."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.special import ndtri

from plant_models.errors import require_between
from plant_models.frozen_arrays import Floats, frozen_arrays
from plant_models.rolling.random_numbers import Purpose
from synth.aim.scene import SceneCuts

MOST_N_PER_KN = 50.0
"""Resistance that stands for a cut that stopped on the stretch."""


@frozen_arrays
class TrueReadings:
    """Of n cuts: the reading of a sensor without error, and the standard deviation of its error, each (n,)."""

    value: Floats
    std: Floats

    def with_error(self, cuts: SceneCuts) -> Floats:
        """Readings as the sensor gives them for these cuts, (n,)."""
        return self.value + self.std * ndtri(cuts.numbers(Purpose.SPEED_NOISE, 1)[:, 0])


class Reading(Protocol):
    """A kind of reading. The higher it is, the worse the cut rolls."""

    def of(self, cuts: SceneCuts) -> TrueReadings:
        """What it reads of these cuts."""


@dataclass(frozen=True)
class ResistanceByTwoSpeeds:
    """Mean resistance on the scene's stretch from the speeds at both ends, each with an error of `speed_std_m_s`:
    w = i − (v2² − v1²)/(2 g' L), N/kN; grade, mass and axles are known ([kozachenko-aimed] has three such points)."""

    speed_std_m_s: float

    def __post_init__(self) -> None:
        require_between("measured stretch: speed_std_m_s", self.speed_std_m_s, 1e-4, 2.0)

    def of(self, cuts: SceneCuts) -> TrueReadings:
        """Resistance on the stretch, N/kN; `MOST_N_PER_KN` for a cut that stopped there."""
        v1, v2 = cuts.measured_speeds_m_s
        stretch, gravity = cuts.scene.stretch, cuts.rolling.cuts.reduced_gravity_m_s2
        length = stretch.to_m - stretch.from_m
        begin = cuts.begin_m
        fall = cuts.rolling.fall_m(begin + length) - cuts.rolling.fall_m(begin)
        value = 1e3 * (fall - (v2**2 - v1**2) / (2.0 * gravity)) / length
        std = 1e3 * self.speed_std_m_s * np.hypot(v1, v2) / (gravity * length)
        return TrueReadings(np.where(v2 > 0.0, value, MOST_N_PER_KN), std)
