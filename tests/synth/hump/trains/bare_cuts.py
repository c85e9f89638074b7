"""Bare cars without resistance on humps worked out by hand: what rolls them, and trains of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.hump import Branch, Edge, HumpGraph, Retarder, Signal, Switch, TrackSection
from synth.hump.rolling.hump_position import Arrivals, NormalHumpPosition
from synth.hump.rolling.hump_routes import HumpRoutes, hump_routes
from synth.hump.rolling.humping import Hump, humped
from synth.hump.rolling.train_memory import Asked, TrainMemory
from synth.simulation.free_roll import Rolled

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

GRAVITY_M_S2 = 9.5
LENGTH_M, FIRST_M, LAST_M = 14.0, 2.0, 12.0
LEAD, LEFT_TRACK, RIGHT_TRACK = 201, 1, 2
THROW_S, RELAY_S = 0.6, 0.2
TRACK_M = 400.0


def edge(to: int | None, length_m: float) -> Edge:
    """Its grade is not used: `EvenFall` has one."""
    return Edge(to, length_m, ((0.0, 0.0),))


def straight() -> HumpGraph:
    """A section from 20 to 50 m, a brake from 82 to 102 m (section 80 to 104 m), and a track."""
    return HumpGraph(
        (
            Signal(LEAD, edge(602, 20.0)),
            TrackSection(602, edge(401, 62.0), 30.0),
            Retarder(401, edge(601, 26.0), ((0.0, 20.0),), 2.0, 22.0, "knp-5-bunch", exit_std_m_s=0.0),
            TrackSection(601, edge(None, TRACK_M), TRACK_M, LEFT_TRACK),
        ),
        (LEAD,),
    )


def one_switch() -> HumpGraph:
    """Points at 46 m, their section from 40 to 51 m, fouling points at 72 m; on either side a brake, then a track."""
    left, right = (Branch(edge(number, 40.0), 4.73, 26.0) for number in (401, 402))
    brakes = (
        Retarder(number, edge(number + 200, 24.0), ((0.0, 20.0),), 1.0, 22.0, "knp-5-bunch", exit_std_m_s=0.0)
        for number in (401, 402)
    )
    tracks = (TrackSection(600 + track, edge(None, TRACK_M), TRACK_M, track) for track in (1, 2))
    points = Switch(1, left, right, entry_joint_m=6.0, exit_joint_m=5.0, throw_s=THROW_S, relay_s=RELAY_S)
    return HumpGraph((Signal(LEAD, edge(1, 46.0)), points, *brakes, *tracks), (LEAD,))


@dataclass(frozen=True)
class EvenFall:
    """Rolls with v² = u² + 2·g'·`fall`·L, whatever the route; `resisted` (rows,): what resistance takes of the fall."""

    fall: float
    resisted: Floats

    def coupled(self, members: Ints) -> EvenFall:
        """All weigh the same, so their resistances are averaged."""
        there = members >= 0
        return EvenFall(self.fall, (self.resisted[np.maximum(members, 0)] * there).sum(axis=1) / there.sum(axis=1))

    def inertia_t(self, rows: Ints) -> Floats:
        """Alike."""
        return np.full(len(rows), 80.0)

    def roll_on(
        self,
        rows: Ints,
        routes: Ints,
        start_m: Floats,
        speed_m_s: Floats,
        stations_m: Floats,
        resistance_n_per_kn: Floats | None = None,
    ) -> Rolled:
        """In closed form; stations that are not ahead change nothing."""
        path = np.maximum(np.maximum.accumulate(stations_m, axis=1) - start_m[:, None], 0.0)
        rate = 2.0 * GRAVITY_M_S2 * (self.fall - self.resisted[rows])
        squares = speed_m_s[:, None] ** 2 + rate[:, None] * path
        speed = np.sqrt(np.maximum(squares, 0.0))
        with np.errstate(divide="ignore", invalid="ignore"):
            time = np.where(path > 0.0, 2.0 * path / (speed_m_s[:, None] + speed), 0.0)
            stop = np.where(rate < 0.0, start_m - speed_m_s**2 / rate, np.inf)
        stopped = start_m[:, None] + path > stop[:, None]
        reached = np.where(stopped.any(axis=1), stop, np.inf)
        return Rolled(np.where(stopped, 0.0, speed), np.where(stopped, np.inf, time), reached)


@dataclass(frozen=True, eq=False)
class BareTrains:
    """`tracks` (trains, cuts) of cars of 80 t; `lengths_m`, of the cuts, with axles 2 m from both ends."""

    routes: HumpRoutes
    tracks: Ints
    lengths_m: Floats
    first: int = 0
    seed: int = 1

    @property
    def trains(self) -> int:
        """How many."""
        return len(self.tracks)

    @property
    def numbers(self) -> Ints:
        """Of each train."""
        return self.first + np.arange(self.trains)

    @property
    def cuts(self) -> int:
        """Of each train."""
        return int(self.tracks.shape[1])

    @property
    def route(self) -> Ints:
        """By rows."""
        return np.searchsorted(self.routes.tracks, self.tracks.reshape(-1))

    @property
    def length_m(self) -> Floats:
        """By rows."""
        return self.lengths_m.reshape(-1)

    @property
    def first_axle_m(self) -> Floats:
        """By rows."""
        return np.full(self.tracks.size, FIRST_M)

    @property
    def last_axle_m(self) -> Floats:
        """By rows."""
        return self.length_m - (LENGTH_M - LAST_M)

    @property
    def mass_t(self) -> Floats:
        """By rows."""
        return np.full(self.tracks.size, 80.0)

    @property
    def axles(self) -> Ints:
        """By rows."""
        return np.full(self.tracks.size, 4)

    @property
    def category(self) -> Ints:
        """By rows."""
        return np.zeros(self.tracks.size, dtype=np.int64)

    def resistance_at(self, rows: Ints, speed_m_s: Floats) -> Floats:
        """None."""
        return np.zeros(len(rows))


@dataclass(frozen=True)
class Orders:
    """Hump speeds (trains, cuts), and exit speeds, whatever the position, of each cut of a train, or of all."""

    speed_m_s: Floats
    exit_m_s: Floats | float = 99.0

    def speed(self, cut: int, memory: TrainMemory) -> Floats:
        """Of one cut."""
        return self.speed_m_s[:, cut]

    def command(self, asked: Asked) -> Floats:
        """(n,)."""
        exits = np.broadcast_to(self.exit_m_s, self.speed_m_s.shape[1])
        return np.full(len(asked.lanes), exits[asked.cut])


def full_brake(arrivals: Arrivals) -> Floats:
    """As much as is wanted."""
    return np.full(len(arrivals), 99.0)


@dataclass(frozen=True)
class Scene:
    """Bare trains over `graph`, which falls evenly."""

    graph: HumpGraph
    tracks: Ints
    orders: Orders
    fall: float = 0.0
    lengths_m: Floats | None = None
    resisted: Floats | None = None
    free_m: float | None = None

    def run(self) -> TrainMemory:
        """What happened."""
        routes = hump_routes(self.graph, LEAD)
        lengths = np.full(self.tracks.shape, LENGTH_M) if self.lengths_m is None else self.lengths_m
        made = BareTrains(routes, self.tracks, lengths)
        resisted = np.zeros(self.tracks.size) if self.resisted is None else self.resisted.reshape(-1)
        rolls = EvenFall(self.fall, resisted)
        positions = tuple(NormalHumpPosition(0.0, full_brake) for _ in range(routes.positions))
        free = np.tile(routes.length_m, (len(self.tracks), 1))
        if self.free_m is not None:
            free[:] = self.free_m
        hump = Hump(routes, positions, rolls)
        return humped(hump, made, free, self.orders, self.orders)  # type: ignore[arg-type]  # bare trains
