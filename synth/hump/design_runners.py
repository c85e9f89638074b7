"""The runners that a hump is designed for, rolled over a route without brakes: a good, a mean and a bad one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from plant_models.cut import GRAVITY_M_S2, ROTATING_MASS_PER_AXLE_T
from plant_models.frozen_arrays import frozen_arrays
from plant_models.hump import Route
from plant_models.library import load_car, load_weight_categories
from plant_models.rolling.car_mix import CarMix, MixedCar
from plant_models.rolling.random_cuts import CutPopulation, DrawnCuts
from plant_models.rolling.resistance_law import HumpNormLaw
from plant_models.rolling.weather import Weather
from synth.simulation.free_roll import rolling_cuts

Floats = NDArray[np.float64]

CAR: Final = "gondola-4"
DRAG_AREA_M2: Final = 1.36 * 8.5
"""C_x·S of a gondola with the air ahead on it; engineering judgement."""

HUMP_SPEED_M_S: Final = 1.7


@dataclass(frozen=True)
class DesignRunner:
    """One car by its mass, its resistance in the yard and the wind against it."""

    name: str
    mass_t: float
    resistance_n_per_kn: float
    head_wind_m_s: float

    @property
    def reduced_gravity_m_s2(self) -> float:
        """g', by which its wheels take part in the motion."""
        axles = len(load_car(CAR).car.axle_offsets_m)
        return GRAVITY_M_S2 / (1.0 + ROTATING_MASS_PER_AXLE_T * axles / self.mass_t)


DESIGN_RUNNERS: Final = (
    DesignRunner("good", 70.0, 0.8, 0.0),
    DesignRunner("mean", 22.0, 1.75, 0.0),
    DesignRunner("bad", 22.0, 4.0, 2.0),
)
"""Engineering judgement, but for the mean: that of the lightest category in [hump-norm]. No table of the runners that
humps are designed for was found."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class RunnerRoll:
    """How `runner` rolls over a route without brakes: where its middle is, and how fast; `stop_m`: where that stops,
    infinite where it reaches the end.

    `energy_head_m`: above the crest; its speed head, above the mean height of its axles.
    """

    runner: DesignRunner
    at_m: Floats
    speed_m_s: Floats
    energy_head_m: Floats
    stop_m: float


def roll_runners(
    route: Route,
    runners: tuple[DesignRunner, ...] = DESIGN_RUNNERS,
    hump_speed_m_s: float = HUMP_SPEED_M_S,
    step_m: float = 1.0,
) -> tuple[RunnerRoll, ...]:
    """Each of `runners`, let go with its middle at the crest at `hump_speed_m_s`, in steps of `step_m`."""
    law, weather = HumpNormLaw(), Weather(head_wind_std_m_s=0.0)
    car, track = load_car(CAR).car, route.roll_track
    mix = CarMix((MixedCar(car, 1.0, DRAG_AREA_M2),))
    count = len(runners)
    mass = np.array([[runner.mass_t] for runner in runners])
    turned = np.array([law.per_switch_m_s2 * b.switches + law.per_degree_m_s2 * b.turn_deg for b in track.bends])
    cuts = DrawnCuts(
        mix=mix,
        types=np.zeros((count, 1), dtype=np.int64),
        mass_t=mass,
        basic_n_per_kn=np.array([[runner.resistance_n_per_kn] for runner in runners]),
        head_wind_m_s=np.array([runner.head_wind_m_s for runner in runners]),
        bend_v2_m_s2=np.tile(turned, (count, 1)),
        bend_head_m=np.zeros((count, len(track.bends))),
        air_n_per_kn=weather.air_n_per_kn(DRAG_AREA_M2) / mass[:, 0],
    )
    population = CutPopulation(mix, load_weight_categories(), law, weather, track.bends)
    rolling = rolling_cuts(population, track, route.yard_from_m, cuts)
    ahead = 0.5 * car.length_m
    middle = np.arange(step_m, route.length_m - ahead, step_m)
    start, speed = np.full(count, ahead), np.full(count, hump_speed_m_s)
    rolled = rolling.roll_on(start, speed, np.tile(middle + ahead, (count, 1)))
    return tuple(
        runner_roll(runner, route, np.concatenate(([0.0], middle)), speeds, stop - ahead)
        for runner, speeds, stop in zip(
            runners, np.hstack((speed[:, None], rolled.speed_m_s)), rolled.stop_m, strict=True
        )
    )


def runner_roll(runner: DesignRunner, route: Route, at_m: Floats, speed_m_s: Floats, stop_m: float) -> RunnerRoll:
    """The part of a roll before the stop, with its energy heads."""
    rolls = speed_m_s > 0.0
    at, speed = at_m[rolls], speed_m_s[rolls]
    offsets = np.asarray(load_car(CAR).car.axle_offsets_m)
    axles = at[:, None] + 0.5 * offsets[-1] - offsets
    head = speed**2 / (2.0 * runner.reduced_gravity_m_s2) - route.roll_track.fall_m(axles).mean(axis=1)
    return RunnerRoll(runner, at, speed, head, float(stop_m))
