"""The same trains for two simulators.

Drawn cuts as the slow simulator takes them, and when they are let go.
The same random trains for the layered simulator and for the slow one, and what each says of them in one form.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plant_models.hump import HumpGraph
from plant_models.rolling.random_cuts import CutPopulation, DrawnCuts
from synth.hump.control.train_population import TrainPopulation
from synth.hump.rolling.hump_position import Arrivals, NormalHumpPosition
from synth.hump.rolling.hump_routes import HumpRoutes, hump_routes
from synth.hump.rolling.humping import Hump, humped
from synth.hump.rolling.train_cuts import TrainCuts, trains
from synth.hump.rolling.train_memory import Asked, TrainMemory
from tests.synth.hump.trains.humped_trains import route_rolling
from tests.synth.hump.trains.slow_train import Heads, SlowBody, SlowCar, SlowCut, SlowTrain


def slow_body(drawn: DrawnCuts, i: int, bend_heads: Mapping[int, Heads]) -> SlowBody:
    """The numbers of one drawn cut, whose row may have room for more cars; heads of bends by track."""
    cars = []
    for place, mass_t in zip(drawn.types[i], drawn.mass_t[i], strict=True):
        car = drawn.mix.cars[place].car
        overhang = (car.length_m - car.axle_offsets_m[-1]) / 2.0
        if mass_t > 0.0:
            cars.append(SlowCar(car.length_m, float(mass_t), tuple(overhang + a for a in car.axle_offsets_m)))
    return SlowBody(
        tuple(cars),
        float((drawn.mass_t[i] * drawn.basic_n_per_kn[i]).sum() / drawn.mass_t[i].sum()),
        float(drawn.head_wind_m_s[i]),
        float(drawn.air_n_per_kn[i]),
        bend_heads,
    )


def crest_times_s(bodies: Sequence[SlowBody], speeds_m_s: Sequence[float]) -> list[float]:
    """When the middles of coupled cuts are at the crest; the train gets faster evenly between two releases."""
    times = [0.0]
    for k in range(1, len(bodies)):
        path = 0.5 * (bodies[k - 1].length_m + bodies[k].length_m)
        times.append(times[-1] + path / (0.5 * (speeds_m_s[k - 1] + speeds_m_s[k])))
    return times


Floats = NDArray[np.float64]
HEADS_M = (0.9, 0.9, 0.5)
"""Energy heads of the full brakes of the positions."""


@dataclass(frozen=True)
class Hardness:
    """How hard the trains are: share of cuts with four times their resistance, which stop and foul, and the least free
    length of the last section of a track."""

    poor_share: float
    room_m: float


ORDINARY, HARD = Hardness(0.0, 250.0), Hardness(0.12, 60.0)
"""Trains whose cuts reach tracks with room for all, and trains in which anything happens."""


@dataclass(frozen=True)
class GivenSpeeds:
    """Hump speeds (trains, cuts)."""

    speed_m_s: Floats

    def speed(self, cut: int, memory: TrainMemory) -> Floats:
        """Those of one cut."""
        return self.speed_m_s[:, cut]


@dataclass(frozen=True)
class GivenExits:
    """Commands (trains, cuts, positions)."""

    exit_m_s: Floats

    def command(self, asked: Asked) -> Floats:
        """Those of one cut and position."""
        return np.asarray(self.exit_m_s[asked.lanes, asked.cut, asked.position])


@dataclass(frozen=True)
class GivenHead:
    """A full brake that takes one head from every cut."""

    head_m: float

    def __call__(self, arrivals: Arrivals) -> Floats:
        """Metres."""
        return np.full(len(arrivals), self.head_m)


@dataclass(frozen=True, eq=False)
class BothTrains:
    """Trains of a hump with all that is asked of them, for either simulator."""

    graph: HumpGraph
    routes: HumpRoutes
    cuts: TrainCuts
    speed_m_s: Floats
    exit_m_s: Floats
    free_m: Floats

    def fast(self) -> TrainMemory:
        """By the layered simulator."""
        rolls = route_rolling(self.cuts.population, self.routes.routes, self.cuts.drawn, threads=1)
        positions = tuple(NormalHumpPosition(0.0, GivenHead(head)) for head in HEADS_M[: self.routes.positions])
        hump = Hump(self.routes, positions, rolls)
        return humped(hump, self.cuts, self.free_m, GivenSpeeds(self.speed_m_s), GivenExits(self.exit_m_s))

    def slow(self, train: int) -> SlowTrain:
        """One of them for the slow simulator."""
        rows = range(train * self.cuts.cuts, (train + 1) * self.cuts.cuts)
        bodies = [slow_body(self.cuts.drawn, row, self.heads(row)) for row in rows]
        speeds = self.speed_m_s[train].tolist()
        made = [
            SlowCut(body, int(self.cuts.track[row]), crest_s, speed, tuple(self.exit_m_s[train, cut].tolist()), HEADS_M)
            for cut, (row, body, crest_s, speed) in enumerate(
                zip(rows, bodies, crest_times_s(bodies, speeds), speeds, strict=True)
            )
        ]
        law, weather = self.cuts.population.law, self.cuts.population.weather
        free_m = dict(zip(self.routes.tracks.tolist(), self.free_m[train].tolist(), strict=True))
        resistances = law.linear_n_per_kn, law.slope_extra_n_per_kn, weather.snow_n_per_kn
        return SlowTrain(tuple(made), self.routes.lead, free_m, *resistances)

    def heads(self, row: int) -> dict[int, Heads]:
        """Heads of the bends of every route: the draws of the cut times the scales of the law."""
        law, drawn = self.cuts.population.law, self.cuts.drawn
        v2, whatever = drawn.bend_v2_m_s2[row].tolist(), drawn.bend_head_m[row].tolist()
        found: dict[int, Heads] = {}
        for route in self.routes.routes:
            scales = [law.bend_scale_m(bend) for bend in route.roll_track.bends]
            found[route.track] = tuple((v2[b] * s[0], whatever[b] * s[1]) for b, s in enumerate(scales))
        return found


def both_trains(
    graph: HumpGraph,
    people: CutPopulation,
    tracks: tuple[int, ...],
    seed: int,
    count: int,
    cuts: int,
    hardness: Hardness = ORDINARY,
) -> BothTrains:
    """`count` trains of `cuts` cuts of one to three cars for few `tracks`, at speeds and commands of all kinds."""
    routes, rng = hump_routes(graph, graph.leads[0]), np.random.default_rng(seed)
    shares = {category.number: 1.0 for category in people.categories.members}
    lists = TrainPopulation(people.mix, people.categories, shares, dict.fromkeys(tracks, 1.0), 1.8, 3)
    made = trains(lists, people, routes.routes, seed, 0, count, cuts)
    poor = np.where(rng.random(len(made)) < hardness.poor_share, 4.0, 1.0)
    made = replace(made, drawn=replace(made.drawn, basic_n_per_kn=made.drawn.basic_n_per_kn * poor[:, None]))
    speed = rng.uniform(1.6, 3.0, (count, 1)) + np.cumsum(rng.uniform(-0.15, 0.15, (count, cuts)), axis=1)
    low, high = np.array([(3.0, 6.0), (2.5, 5.0), (0.8, 2.0)])[: routes.positions].T
    exits = rng.uniform(low, high, (count, cuts, routes.positions))
    begins = np.array([route.elements[-1].from_m for route in routes.routes])
    free = rng.uniform(begins + hardness.room_m, routes.length_m, (count, len(begins)))
    return BothTrains(graph, routes, made, np.clip(speed, 1.4, 3.3), exits, free)
