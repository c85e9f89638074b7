"""Readings of a cut that only studies suppose: a radar that looks upstream, and a weigher."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from synth.aim.readings import MOST_N_PER_KN, TrueReadings
from synth.aim.scene import SceneCuts


@dataclass(frozen=True)
class ResistanceByRadar:
    """Mean resistance on the last `length_m` of the scene's stretch by regression of e on path: a radar that looks
    upstream reads the speed each `sample_period_s` with an independent error of `speed_std_m_s`.

    Standard deviation √12·v·σ_v·10³/(√N·g'·L) for N readings at nearly even speed v.
    """

    speed_std_m_s: float
    length_m: float
    sample_period_s: float = 0.1

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

    def of(self, cuts: SceneCuts) -> TrueReadings:
        """Less the mass, tonnes."""
        mass = cuts.rolling.cuts.cut_mass_t
        return TrueReadings(-mass, self.relative_std * mass)
