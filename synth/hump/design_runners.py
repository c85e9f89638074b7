"""The runners that a hump is designed for, rolled over its routes without brakes: very good, good, mean and bad ones;
and what stands where on these routes, with the speeds at which they come there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from plant_models.cut import GRAVITY_M_S2, ROTATING_MASS_PER_AXLE_T
from plant_models.frozen_arrays import Floats, frozen_arrays
from plant_models.hump import HumpGraph, Retarder, Route, RouteElement, Switch, TrackSection
from plant_models.library import load_car, load_weight_categories
from plant_models.rolling.car_mix import CarMix, MixedCar
from plant_models.rolling.random_cuts import CutPopulation, DrawnCuts
from plant_models.rolling.resistance_law import HumpNormLaw
from plant_models.rolling.roll_track import Weather
from synth.hump.configuration.sections import DesignSettings
from synth.kernels.cache import guarded
from synth.simulation.free_roll import rolling_cuts

CAR: Final = "gondola-4"
DRAG_AREA_M2: Final = 1.36 * 8.5
"""C_x·S of a gondola with the air ahead on it; engineering judgement."""

HUMP_SPEED_M_S: Final = DesignSettings().hump_speed_m_s


@dataclass(frozen=True)
class DesignRunner:
    """One car by its mass, its resistance in the yard and the wind against it."""

    name: str
    mass_t: float
    resistance_n_per_kn: float
    head_wind_m_s: float

    @property
    def axles(self) -> int:
        """Those of the car."""
        return len(load_car(CAR).car.axle_offsets_m)

    @property
    def reduced_gravity_m_s2(self) -> float:
        """g', by which its wheels take part in the motion."""
        return GRAVITY_M_S2 / (1.0 + ROTATING_MASS_PER_AXLE_T * self.axles / self.mass_t)


MEAN_RUNNER: Final = DesignRunner("mean", 22.0, 1.75, 0.0)
"""That of the lightest category in [hump-norm]."""


def good_runner(asked: DesignSettings) -> DesignRunner:
    """The good one."""
    return DesignRunner("good", asked.good_mass_t, asked.good_n_per_kn, asked.good_head_wind_m_s)


def bad_runner(asked: DesignSettings) -> DesignRunner:
    """The bad one, in the worst weather."""
    return DesignRunner("bad", asked.bad_mass_t, asked.bad_n_per_kn, asked.bad_head_wind_m_s)


def very_good_runner(asked: DesignSettings) -> DesignRunner:
    """The one that needs most brake."""
    return DesignRunner("very good", asked.very_good_mass_t, asked.very_good_n_per_kn, asked.good_head_wind_m_s)


DESIGN_RUNNERS: Final = (good_runner(DesignSettings()), MEAN_RUNNER, bad_runner(DesignSettings()))
"""Those that pictures and checks of a hump show."""


def design_population() -> CutPopulation:
    """Law and weather of design runners, each of which has a resistance and a wind of its own."""
    mix = CarMix((MixedCar(load_car(CAR).car, 1.0, DRAG_AREA_M2),))
    return CutPopulation(mix, load_weight_categories(), HumpNormLaw(), Weather(head_wind_std_m_s=0.0))


def single_cars(population: CutPopulation, runners: Sequence[DesignRunner], bends: int) -> DrawnCuts:
    """A cut of one car for each of `runners`, whose `bends` are mean draws (`DrawnCuts.on_bends`)."""
    count = len(runners)
    mass = np.array([[runner.mass_t] for runner in runners])
    draws = np.full((count, bends), population.law.mean_bend_draw)
    return DrawnCuts(
        mix=population.mix,
        types=np.zeros((count, 1), dtype=np.int64),
        mass_t=mass,
        basic_n_per_kn=np.array([[runner.resistance_n_per_kn] for runner in runners]),
        head_wind_m_s=np.array([runner.head_wind_m_s for runner in runners]),
        bend_v2_m_s2=draws,
        bend_head_m=draws,
        air_n_per_kn=population.weather.air_n_per_kn(DRAG_AREA_M2) / mass[:, 0],
    )


@frozen_arrays
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
    runners: Sequence[DesignRunner] = DESIGN_RUNNERS,
    hump_speed_m_s: float = HUMP_SPEED_M_S,
    step_m: float = 1.0,
) -> tuple[RunnerRoll, ...]:
    """Each of `runners`, let go with its middle at the crest at `hump_speed_m_s`, in steps of `step_m`."""
    population, car, track = design_population(), load_car(CAR).car, route.roll_track
    count = len(runners)
    cuts = single_cars(population, runners, len(track.bends)).on_bends(population.law, track.bends)
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


DIGITS = 3
"""Of metres by which places are told apart."""


@dataclass(frozen=True)
class RolledRoute:
    """A route, and how the good and the bad runner roll over it without brakes."""

    route: Route
    good: RunnerRoll
    bad: RunnerRoll

    def fall_m(self, at_m: float) -> float:
        """From the crest to `at_m`."""
        return float(self.route.roll_track.fall_m(np.array([at_m]))[0])

    @property
    def retarders(self) -> tuple[RouteElement, ...]:
        """From the crest on."""
        return tuple(each for each in self.route.elements if isinstance(each.vertex, Retarder))

    @property
    def switches(self) -> tuple[RouteElement, ...]:
        """From the crest on."""
        return tuple(each for each in self.route.elements if isinstance(each.vertex, Switch))

    @property
    def last_m(self) -> float:
        """Behind the last switch and the last position; 0 where there is none."""
        return max((each.to_m for each in (*self.switches, *self.retarders)), default=0.0)

    @property
    def track_m(self) -> float:
        """Where its track begins."""
        of_track = (e.at_m for e in self.route.elements if isinstance(e.vertex, TrackSection) and e.vertex.track)
        return next(of_track)


def rolled_routes(graph: HumpGraph) -> tuple[RolledRoute, ...]:
    """Every route of the hump, with the design runners on it."""
    routes = [route for lead in graph.leads for route in graph.routes(lead).values()]
    runners = (DESIGN_RUNNERS[0], DESIGN_RUNNERS[-1])
    return tuple(RolledRoute(route, *guarded(roll_runners, route, runners)) for route in routes)


@dataclass(frozen=True)
class Place:
    """Elements `numbers` of one `kind` that lie equally far from the crest: at `at_m`, their insulated sections from
    `from_m` to `to_m`; of tracks the numbers are those of the tracks.

    `fall_m`: from the crest, the least of all ways. `good_m_s`: of the good runner, the fastest; `bad_m_s`: of the bad
    one, the slowest; None where it stands before.
    """

    kind: str
    numbers: tuple[int, ...]
    at_m: float
    from_m: float
    to_m: float
    fall_m: float
    good_m_s: float | None
    bad_m_s: float | None


def places_of(rolled: Sequence[RolledRoute]) -> tuple[Place, ...]:
    """Of all routes, from the crest on."""
    met: dict[tuple[float, str, float, float], list[tuple[int, RolledRoute]]] = {}
    for each in rolled:
        for kind, number, element in elements_of(each.route):
            at, begin, end = (round(metres, DIGITS) for metres in (element.at_m, element.from_m, element.to_m))
            met.setdefault((at, kind, begin, end), []).append((number, each))
    return tuple(place_of(*key, met[key]) for key in sorted(met))


def place_of(at_m: float, kind: str, from_m: float, to_m: float, found: Sequence[tuple[int, RolledRoute]]) -> Place:
    """The place of the elements `found`, each with the ways on which it lies."""
    good = [speed_at(each.good, at_m) for _, each in found]
    bad = [speed_at(each.bad, at_m) for _, each in found]
    fast = [speed for speed in good if speed is not None]
    slow = [speed for speed in bad if speed is not None]
    return Place(
        kind,
        numbers=tuple(sorted({number for number, _ in found})),
        at_m=at_m,
        from_m=from_m,
        to_m=to_m,
        fall_m=min(each.fall_m(at_m) for _, each in found),
        good_m_s=max(fast, default=None),
        bad_m_s=min(slow) if len(slow) == len(bad) else None,
    )


def elements_of(route: Route) -> Iterator[tuple[str, int, RouteElement]]:
    """(kind, number, element) of what the place is told of."""
    for element in route.elements[1:]:
        vertex = element.vertex
        if isinstance(vertex, TrackSection) and vertex.track is not None:
            yield "track", vertex.track, element
        else:
            kind = {Switch: "switch", Retarder: "retarder", TrackSection: "section"}.get(type(vertex), "signal")
            yield kind, element.number, element


def speed_at(roll: RunnerRoll, at_m: float) -> float | None:
    """With its middle there; None where the runner stands before."""
    if at_m >= roll.stop_m or at_m > roll.at_m[-1] + 1.0:
        return None
    return float(np.interp(at_m, roll.at_m, roll.speed_m_s))
