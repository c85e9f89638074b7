"""The wind as an anemometer tells it, alone or beside a measured resistance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from plant_models.frozen_arrays import Floats, frozen_arrays
from plant_models.rolling.random_numbers import Purpose
from synth.aim.knowledge import Requirement, likelihood, not_falling
from synth.aim.limit_speed import thresholds_of
from synth.aim.readings import Reading, TrueReadings
from synth.aim.scene import SceneCuts

TAIL = 0.001
"""Share of winds and readings beyond each end of the nodes; they get the commands of the end."""


@dataclass(frozen=True)
class WindByAnemometer:
    """Head wind, m/s; what the wind of a cut differs from what is told is normal with `std_m_s`."""

    std_m_s: float

    def of(self, cuts: SceneCuts) -> TrueReadings:
        """The head wind of each cut."""
        wind = cuts.rolling.cuts.head_wind_m_s
        return TrueReadings(wind, np.full(len(wind), self.std_m_s))

    def told(self, cuts: SceneCuts) -> Floats:
        """The wind as told, (n,); its error is independent of that of speeds, and of the wind."""
        return np.asarray(cuts.rolling.cuts.head_wind_m_s + self.std_m_s * ndtri(cuts.numbers(Purpose.WIND, 2)[:, 1]))


@frozen_arrays
class CommandsByReadingAndWind:
    """`speeds_m_s` (winds, readings) at the nodes `winds` and `readings`; linear between, constant beyond."""

    reading: Reading
    wind: WindByAnemometer
    winds: Floats
    readings: Floats
    speeds_m_s: Floats

    def of(self, cuts: SceneCuts) -> Floats:
        """By what is told of these cuts, (n, 1)."""
        told = self.reading.of(cuts).with_error(cuts)
        place = np.interp(self.wind.told(cuts), self.winds, np.arange(len(self.winds)))
        low = np.minimum(place.astype(np.int64), len(self.winds) - 2)
        by_wind = np.stack([np.interp(told, self.readings, row) for row in self.speeds_m_s])
        rows = np.arange(len(told))
        return np.asarray(by_wind[low, rows] + (place - low) * (by_wind[low + 1, rows] - by_wind[low, rows]))[:, None]


@dataclass(frozen=True)
class ByReadingAndWind:
    """Category, cars, a reading and the wind: Bayes' rule on the drawn cuts, as `ByReading`, for one place."""

    reading: Reading
    wind: WindByAnemometer
    nodes: int
    wind_nodes: int

    def commands(self, cuts: SceneCuts, thresholds_m_s: Floats, requirement: Requirement) -> CommandsByReadingAndWind:
        """The weighted quantiles at evenly spaced readings and winds."""
        true, thresholds = self.reading.of(cuts), thresholds_of(thresholds_m_s)
        head = self.wind.of(cuts)
        winds = spanning(head.value, self.wind_nodes)
        readings = spanning(true.with_error(cuts), self.nodes)
        of_wind = [likelihood(wind, head.value, head.std) for wind in winds]
        of_reading = [likelihood(reading, true.value, true.std) for reading in readings]
        speeds = [
            not_falling(
                np.array(
                    [
                        thresholds.weighted_limit_speeds(a * b, requirement.p_overspeed, requirement.bounds_m_s)
                        for b in of_reading
                    ]
                )
            )[:, 0]
            for a in of_wind
        ]
        return CommandsByReadingAndWind(self.reading, self.wind, winds, readings, np.array(speeds))


def spanning(values: Floats, count: int) -> Floats:
    """`count` evenly spaced nodes that span `values` but for both tails."""
    low, high = np.quantile(values, (TAIL, 1.0 - TAIL))
    return np.linspace(float(low), float(high), count)
