"""What limits an aim by measured resistance: bends and wind in the measured stretch, its length, the sensors; and
the wind as an anemometer tells it, alone or beside a measured resistance.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtri

from plant_models.frozen_arrays import Floats, frozen_arrays
from plant_models.rolling.random_numbers import Purpose
from scripts.studies.aiming.cuts import POINTS, FreeDistance, weight_category, with_bends
from scripts.studies.aiming.refinements import ByRegression, LightnessByWeigher, NearestRecord, ResistanceByRadar
from scripts.studies.aiming.trial import Cuts, Draws, Outcome, outcomes, samples
from scripts.studies.cases import side_by_side
from synth.aim.knowledge import (
    ByCategory,
    ByReading,
    Knowledge,
    Reading,
    Requirement,
    ResistanceByTwoSpeeds,
    TrueReadings,
    likelihood,
    not_falling,
    thresholds_of,
)
from synth.aim.position_models import NormalPosition
from synth.aim.scene import AimScene, SceneCuts

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


EXIT_STD_M_S = 0.03
"""What the exported tables reach at other positions (docs/reference/results.md)."""

ANEMOMETER_STD_M_S = 0.5
"""What the wind of a cut is uncertain by where an anemometer tells the wind of the hour; assumed."""

LONGER_FROM_M = 178.0
"""Exit of the bunch position: the longest stretch that there is."""

NODES, WIND_NODES = 33, 13
"""Of the resistance and of the wind, at which commands are worked out."""

RADAR_STD_M_S = 0.05
RADAR_M = 50.0


@dataclass(frozen=True)
class Measuring:
    """A way to measure: what is known, and whether the stretch is straight or longer."""

    name: str
    knowledge: Knowledge
    straight: bool = False
    longer: bool = False


@dataclass(frozen=True)
class Measured:
    """Outcomes of one way over the free distance, light single cars."""

    name: str
    outcomes: tuple[Outcome | None, ...]


def two(std_m_s: float) -> ByReading:
    """Two speeds, Bayes' rule."""
    return ByReading(ResistanceByTwoSpeeds(std_m_s), NODES)


def two_and_wind(std_m_s: float) -> ByReadingAndWind:
    """Two speeds and the wind."""
    return ByReadingAndWind(ResistanceByTwoSpeeds(std_m_s), WIND, NODES, WIND_NODES)


WIND = WindByAnemometer(ANEMOMETER_STD_M_S)
RADAR = ByReading(ResistanceByRadar(RADAR_STD_M_S, RADAR_M), NODES)

WAYS = (
    Measuring("category alone", ByCategory()),
    Measuring("category, anemometer", ByReading(WIND, NODES)),
    Measuring("weight, exact", ByRegression(LightnessByWeigher(1e-4))),
    Measuring("three control points, nearest of 300 records", NearestRecord(POINTS, 300)),
    Measuring("two speeds, σ_v 0.1", two(0.1)),
    Measuring("two speeds, σ_v 0.03", two(0.03)),
    Measuring("two speeds, σ_v 0.01", two(0.01)),
    Measuring("two speeds, σ_v 0.03, stretch of 132 m", two(0.03), longer=True),
    Measuring("two speeds, σ_v 0.03, anemometer", two_and_wind(0.03)),
    Measuring("two speeds, σ_v 0.1, straight stretch", two(0.1), straight=True),
    Measuring("two speeds, σ_v 0.03, straight stretch", two(0.03), straight=True),
    Measuring("two speeds, σ_v 0.01, straight stretch", two(0.01), straight=True),
    Measuring("two speeds, σ_v 0.03, straight, anemometer", two_and_wind(0.03), straight=True),
    Measuring("two speeds, σ_v 0.01, straight, anemometer", two_and_wind(0.01), straight=True),
    Measuring("radar 0.05 on the last 50 m", RADAR),
    Measuring("radar 0.05 on the last 50 m, straight", RADAR, straight=True),
    Measuring("regression on two speeds, σ_v 0.03", ByRegression(ResistanceByTwoSpeeds(0.03))),
)


def measured(
    hump: AimScene, metres: tuple[float, ...], p: float, draws: Draws, ways: tuple[Measuring, ...]
) -> Iterator[Measured]:
    """The outcomes of each way."""
    found = side_by_side(lambda way: outcomes(of_way(way, hump, metres, p, draws)), ways)
    yield from (Measured(way.name, of_one) for way, of_one in zip(ways, found, strict=True))


def of_way(way: Measuring, hump: AimScene, metres: tuple[float, ...], p: float, draws: Draws) -> Floats:
    """Figures of every replicate."""
    scene = with_bends(hump, ()) if way.straight else hump
    if way.longer:
        scene = replace(scene, stretch=replace(scene.stretch, from_m=LONGER_FROM_M))
    cuts = Cuts(scene, weight_category(scene, "L"))
    return samples(cuts, FreeDistance(metres), NormalPosition(EXIT_STD_M_S), way.knowledge, p, draws)
