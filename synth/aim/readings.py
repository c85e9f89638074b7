"""What can be measured of a cut before its exit speed is set, and how well."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

from plant_models.errors import require_between
from plant_models.frozen_arrays import frozen_arrays
from plant_models.rolling.random_numbers import Purpose
from synth.aim.scene import SceneCuts

Floats = NDArray[np.float64]

MOST_N_PER_KN = 50.0
"""Resistance that stands for a cut that stopped on the stretch."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
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


@dataclass(frozen=True)
class ResistanceByRadar:
    """Mean resistance on the last `length_m` of the scene's stretch by regression of e on path: a radar that looks
    upstream reads the speed each `sample_period_s` with an independent error of `speed_std_m_s`.

    Standard deviation √12·v·σ_v·10³/(√N·g'·L) for N readings at nearly even speed v.
    """

    speed_std_m_s: float
    length_m: float
    sample_period_s: float = 0.1

    def __post_init__(self) -> None:
        require_between("radar: speed_std_m_s", self.speed_std_m_s, 1e-4, 2.0)
        require_between("radar: length_m", self.length_m, 1.0, 1000.0)
        require_between("radar: sample_period_s", self.sample_period_s, 1e-3, 10.0)

    def of(self, cuts: SceneCuts) -> TrueReadings:
        """Resistance on that stretch, N/kN; `MOST_N_PER_KN` for a cut that stops there."""
        rolling, scene = cuts.rolling, cuts.scene
        ends = scene.stretch.to_m + rolling.cuts.first_axle_m
        begins = np.maximum(ends - self.length_m, cuts.begin_m + 1e-3)
        rolled = rolling.roll_on(cuts.begin_m, cuts.stretch_speed_m_s, np.stack([begins, ends], axis=1))
        v1, v2 = rolled.speed_m_s[:, 0], rolled.speed_m_s[:, 1]
        gravity, length = rolling.cuts.reduced_gravity_m_s2, ends - begins
        fall = rolling.fall_m(ends) - rolling.fall_m(begins)
        value = 1e3 * (fall - (v2**2 - v1**2) / (2.0 * gravity)) / length
        speed = np.maximum(0.5 * (v1 + v2), 0.1)
        readings = np.maximum(length / (speed * self.sample_period_s), 2.0)
        std = math.sqrt(12.0) * 1e3 * speed * self.speed_std_m_s / (np.sqrt(readings) * gravity * length)
        return TrueReadings(np.where(v2 > 0.0, value, MOST_N_PER_KN), std)


@dataclass(frozen=True)
class LightnessByWeigher:
    """Less the mass of the cut, tonnes, by a weigher with a relative error of `relative_std`: light cuts roll worse."""

    relative_std: float = 0.02

    def __post_init__(self) -> None:
        require_between("weigher: relative_std", self.relative_std, 1e-4, 0.5)

    def of(self, cuts: SceneCuts) -> TrueReadings:
        """Less the mass, tonnes."""
        mass = cuts.rolling.cuts.cut_mass_t
        return TrueReadings(-mass, self.relative_std * mass)
