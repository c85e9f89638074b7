"""How cuts couple that were commanded something: over-speeds, gaps and coupling speeds, each with its interval."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, frozen_arrays
from synth.aim.position_models import ExitSpeeds
from synth.aim.scene import SceneCuts
from synth.simulation.exit_statistics import NORMAL_95, clopper_pearson


@dataclass(frozen=True)
class Figure:
    """A figure and its 95 % interval."""

    value: float
    low95: float
    high95: float


@frozen_arrays
class Couplings:
    """n cuts that meet standing cars at one place: `speed_m_s` (n,) of coupling, 0 if they stop before; `gap_m` (n,)
    that then stays free, 0 if they couple; `cars` of each cut."""

    speed_m_s: Floats
    gap_m: Floats
    limit_m_s: float
    cars: int

    @property
    def overspeed(self) -> Figure:
        """Share that couples too fast, exact interval (Clopper and Pearson)."""
        return self.faster_than(self.limit_m_s)

    def faster_than(self, speed_m_s: float) -> Figure:
        """Share that couples faster than `speed_m_s`."""
        hits, n = int((self.speed_m_s > speed_m_s).sum()), len(self.speed_m_s)
        low, high = clopper_pearson(hits, n)
        return Figure(hits / n, low, high)

    def of(self, which: Bools) -> Couplings:
        """Some of these."""
        return Couplings(self.speed_m_s[which], self.gap_m[which], self.limit_m_s, self.cars)

    @property
    def gap_per_car_m(self) -> Figure:
        """Mean gap that a car leaves, normal interval."""
        gaps = self.gap_m / self.cars
        mean, half = float(gaps.mean()), NORMAL_95 * float(gaps.std(ddof=1)) / np.sqrt(len(gaps))
        return Figure(mean, mean - half, mean + half)


def couplings(cuts: SceneCuts, exits: ExitSpeeds, commanded_m_s: Floats, arrival_m: Floats) -> Couplings:
    """Let `cuts` out with `commanded_m_s` (n,) towards standing cars whose head is at `arrival_m` (n,).

    Over-speed is told by the roll forwards, which knows nothing of the thresholds that the commands come from. Raises
    `ValueError` for a command that is NaN: where none meets the requirement, the caller says what is done.
    """
    if not np.isfinite(commanded_m_s).all():
        raise ValueError("couplings: a command is not a finite number")
    rolled = cuts.rolling.roll_on(cuts.release_m, exits.at(commanded_m_s), arrival_m[:, None])
    gap = np.where(np.isfinite(rolled.stop_m), np.maximum(arrival_m - rolled.stop_m, 0.0), 0.0)
    return Couplings(rolled.speed_m_s[:, 0], gap, cuts.scene.coupling_speed_m_s, cuts.rolling.cuts.cars)
