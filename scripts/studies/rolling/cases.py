"""Cuts and tracks that the study of rolling rolls: library cars, both laws, a park track and a whole hump."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models import TrackProfile
from plant_models.frozen_arrays import Floats
from plant_models.library import load_car, load_weight_categories
from plant_models.rolling.car_mix import CarMix, MixedCar
from plant_models.rolling.random_cuts import CutPopulation, DrawnCuts
from plant_models.rolling.resistance_law import HumpNormLaw, ResistanceLaw, Tb10062Law
from plant_models.rolling.roll_track import Bend, RollTrack, Weather
from synth.simulation.free_roll import RollingCuts, rolling_cuts

SHARES_AND_DRAG: dict[str, tuple[float, float]] = {
    "gondola-4": (0.45, 11.6),
    "tank-4": (0.20, 10.5),
    "box-4": (0.15, 10.9),
    "hopper-4": (0.12, 11.0),
    "flat-4": (0.08, 6.2),
}
"""Share and C_x·S in m²; engineering judgement all of them."""

COUPLING_M_S = 1.39
WIND_STD_M_S = 3.0


@dataclass(frozen=True)
class RollCase:
    """Where cuts start, over how much they roll, and on what.

    `start_m`: of the last axle; `length_m`: from there to the standing cars; `speed_m_s`: least and largest at the
    start of a forward roll, evenly spread over the cuts.
    """

    name: str
    track: RollTrack
    start_m: float
    length_m: float
    speed_m_s: tuple[float, float]
    law: ResistanceLaw
    category: str = "Л"

    @property
    def population(self) -> CutPopulation:
        """Where the cuts come from."""
        weather = Weather(head_wind_std_m_s=WIND_STD_M_S)
        return CutPopulation(mix(), load_weight_categories(), self.law, weather, self.track.bends)

    def drawn(self, cars: int, seed: int, count: int) -> DrawnCuts:
        """`count` cuts of `cars` cars each."""
        people = self.population
        return people.draw(people.categories.named(self.category), cars, seed, 0, count)

    def rolling(self, cars: int, seed: int, count: int) -> RollingCuts:
        """`count` drawn cuts of `cars` cars, ready to roll."""
        return rolling_cuts(self.population, self.track, PARK_EXIT_M, self.drawn(cars, seed, count))

    def extra_n_per_kn(self, at_m: Floats) -> Floats:
        """Resistance of an axle beyond that of its cut: the law's for the slope."""
        return np.where((at_m >= 0.0) & (at_m < PARK_EXIT_M), self.law.slope_extra_n_per_kn, 0.0)

    def starts_m(self, rolling: RollingCuts) -> Floats:
        """Heads at the start, (n,)."""
        return np.asarray(self.start_m + rolling.cuts.last_axle_m)

    def speeds_m_s(self, count: int) -> Floats:
        """Speeds at the start of a forward roll, (n,): in an order that has nothing to do with the draws."""
        golden = (0.5 + 0.6180339887498949 * np.arange(count)) % 1.0
        return np.asarray(self.speed_m_s[0] + (self.speed_m_s[1] - self.speed_m_s[0]) * golden)


def mix() -> CarMix:
    """Five types of the library."""
    return CarMix(tuple(MixedCar(load_car(name).car, *of) for name, of in SHARES_AND_DRAG.items()))


PARK_EXIT_M = 336.0

HUMP = RollTrack(
    TrackProfile((0.0, 40.0, 66.0, 98.0, 138.0, 178.0, 338.0, 770.0), (45.0, 22.0, 12.0, 10.0, 8.0, 1.5, 0.8, 0.0)),
    970.0,
    (
        Bend(42.0, 52.0, 1, 4.73),
        Bend(112.0, 122.0, 1, 4.73),
        Bend(184.0, 194.0, 1, 4.73),
        Bend(214.0, 224.0, 1, 4.73),
        Bend(246.0, 256.0, 1, 4.73),
        Bend(270.0, 300.0, 0, 14.0),
        Bend(350.0, 380.0, 0, 6.0),
    ),
)
"""A hump of 32 tracks, every number engineering judgement."""

CASES: tuple[RollCase, ...] = (
    RollCase("park track", HUMP, PARK_EXIT_M, 500.0, (0.5, 4.5), HumpNormLaw()),
    RollCase("park track, TB 10062", HUMP, PARK_EXIT_M, 500.0, (0.5, 4.5), Tb10062Law()),
    RollCase("from the crest", HUMP, 0.0, 500.0, (1.0, 2.5), HumpNormLaw()),
)
