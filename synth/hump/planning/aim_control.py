"""The control of the last position: the exit speed that aims each cut at the standing cars of its track, by aim tables
for each group of routes and weight category; and the resistance as these have it, mean over the stretch that they name,
bends and air included.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.hump.planning.free_stretch import SHORTEST_M, ExpectedWay, SpeedSensors
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.rolling.route_rolling import RouteRolling
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import Asked, TrainMemory
from synth.kernels.aim_speeds import aim_exit_speeds
from tuning_tables.aim import AimAxes
from tuning_tables.aim.axes import aim_grid
from tuning_tables.programs.aim_speed import AimGrid


@dataclass(frozen=True)
class CategoryAim:
    """Exit speeds for one weight category, of a table or made for a simulation alone: `by_category`, and `measured`,
    where a cut's resistance was read.

    `mean_n_per_kn`: the mean reading of such cuts.
    """

    by_category: AimGrid
    measured: AimGrid | None = None
    mean_n_per_kn: float = np.nan


@frozen_arrays
class HumpAim:
    """Exit speeds of the last position: `tables`, by group of routes and by place of the weight category in its set.

    `group` (routes,): the group of each route. `lowest_m_s`, of all or (groups, categories), is commanded where no
    speed is known to be safe. `stretch_m` (routes, 2): from where to where the tables have the resistance measured, NaN
    for routes on which it is that of the free stretch ahead of the last position; None: for all.
    """

    group: Ints
    tables: tuple[tuple[CategoryAim, ...], ...]
    lowest_m_s: float | Floats
    stretch_m: Floats | None = None

    @property
    def lowest_by_table_m_s(self) -> Floats:
        """(groups, categories)."""
        return np.broadcast_to(self.lowest_m_s, (len(self.tables), len(self.tables[0])))

    def command_m_s(
        self, routes: Ints, category: Ints, cars: Ints, free_distance_m: Floats, reading_n_per_kn: Floats | None = None
    ) -> Floats:
        """Exit speeds for cuts on `routes`, (n,) all of them; a reading that is NaN was not made.

        The rule is that of aim tables (`tuning_tables.aim`), with one difference: longer cuts than the longest listed
        are commanded as those. Exported tables are used only where none are longer.
        """
        speeds = np.full(len(routes), np.nan)
        together = self.group[routes] * len(self.tables[0]) + category
        for key in np.unique(together):
            rows = np.flatnonzero(together == key)
            table = self.tables[key // len(self.tables[0])][key % len(self.tables[0])]
            if reading_n_per_kn is not None and table.measured is not None:
                told = ~np.isnan(reading_n_per_kn[rows])
                read, rows = rows[told], rows[~told]
                speeds[read] = answer(table.measured, cars[read], free_distance_m[read], reading_n_per_kn[read])
            if len(rows):
                speeds[rows] = answer(table.by_category, cars[rows], free_distance_m[rows])
        return np.where(np.isnan(speeds), self.lowest_by_table_m_s[self.group[routes], category], speeds)

    def expected_m_s(self, routes: Ints, category: Ints, cars: Ints, free_distance_m: Floats, measured: bool) -> Floats:
        """What is expected before the train: for the mean reading where cuts will be `measured`, else by category."""
        reading = None
        if measured:
            means = np.array([[table.mean_n_per_kn for table in group] for group in self.tables])
            reading = means[self.group[routes], category]
        return self.command_m_s(routes, category, cars, free_distance_m, reading)


def answer(table: AimGrid, cars: Ints, free_distance_m: Floats, reading_n_per_kn: Floats | None = None) -> Floats:
    """What the rule answers, NaN for nothing; more cars than listed count as the most that are."""
    reading = np.full(len(cars), np.nan) if reading_n_per_kn is None else reading_n_per_kn
    listed = np.minimum(cars, table.cars[table.listed - 1])
    return aim_exit_speeds(table, listed, free_distance_m, reading).astype(np.float64)


def no_speeds() -> AimGrid:
    """Nodes without any speed, for cuts that no train has."""
    return aim_grid(AimAxes(np.array([1]), np.zeros(1)), np.full((1, 1), np.nan))


def no_aim(routes: int, categories: int, lowest_m_s: float) -> HumpAim:
    """Where no position aims: nobody asks for these speeds."""
    tables = (tuple(CategoryAim(no_speeds()) for _ in range(categories)),)
    return HumpAim(np.zeros(routes, dtype=np.int64), tables, lowest_m_s)


def joined_aims(parts: Sequence[tuple[Ints, HumpAim]], routes: int) -> HumpAim:
    """One aim for all `routes`, of (rows, aim of these rows) that are no two for one route. Routes on which
    no position aims are in none, and nobody asks for them."""
    group, stretch = np.zeros(routes, dtype=np.int64), np.full((routes, 2), np.nan)
    tables: list[tuple[CategoryAim, ...]] = []
    for rows, aim in parts:
        group[rows] = len(tables) + aim.group
        if aim.stretch_m is not None:
            stretch[rows] = aim.stretch_m
        tables += aim.tables
    lowest = np.concatenate([aim.lowest_by_table_m_s for _, aim in parts])
    return HumpAim(group, tuple(tables), lowest, stretch)


class AimReading(Protocol):
    """What is read of cuts before they are aimed."""

    def n_per_kn(self, asked: Asked) -> Floats:
        """Readings (n,), NaN where there is none."""


@frozen_arrays
class ReadOnStretch:
    """w = i − (v2² − v1²)/(2 g' L) by the speeds of the first axle at `stretch_m` (routes, 2), as
    `ResistanceByTwoSpeeds` reads it of the cuts that aim tables are made of; NaN for routes without such a stretch.

    A long cut may be still braked when its first axle is at the beginning: its reading begins where it is free. On less
    than `SHORTEST_M` there is none. `rolls`: the cuts as they roll; `sensors` tell the errors of both speeds.
    """

    sensors: SpeedSensors
    rolls: RouteRolling
    stretch_m: Floats

    def n_per_kn(self, asked: Asked) -> Floats:
        """See `AimReading`; all that is read is over when the first axle is at the entrance."""
        trains, routes = self.sensors.trains, self.sensors.routes
        rows = asked.lanes * trains.cuts + asked.cut
        free_m, free_m_s = freed(routes, self.sensors, asked, rows)
        ends = self.stretch_m[asked.routes] + trains.first_axle_m[rows][:, None]
        ends[:, 0] = np.maximum(ends[:, 0], free_m)
        length = ends[:, 1] - ends[:, 0]
        tells = (length >= SHORTEST_M) & (free_m_s > 0.0)  # NaN of a route without a stretch is False
        found = np.full(len(rows), np.nan)
        if tells.any():
            own, on, places = rows[tells], asked.routes[tells], ends[tells]
            speeds = self.rolls.roll_on(own, on, free_m[tells], free_m_s[tells], places).speed_m_s
            some = asked.chosen(tells)
            first, last = (self.sensors.read(some, self.place + end, speeds[:, end]) for end in range(2))
            fall = self.rolls.fall_m(own, on, places[:, 1]) - self.rolls.fall_m(own, on, places[:, 0])
            lost = fall - (last**2 - first**2) / (2.0 * self.rolls.cuts.reduced_gravity_m_s2[own])
            found[tells] = np.where((first > 0.0) & (last > 0.0), 1e3 * lost / length[tells], np.nan)
        return found

    @property
    def place(self) -> int:
        """Number of the first of both sensors, beyond those of the positions: their errors are their own."""
        return 2 * self.sensors.routes.positions


def freed(routes: HumpRoutes, sensors: SpeedSensors, asked: Asked, rows: Ints) -> tuple[Floats, Floats]:
    """Where the heads are and how fast (n,) when the free roll to the position that is asked for begins: where the last
    axles leave the position ahead of it, or at the crest; speed 0 where that was not seen."""
    memory: TrainMemory = asked.memory
    place, trains = asked.position - 1, sensors.trains
    if place < 0:
        return 0.5 * trains.length_m[rows], memory.hump_speed_m_s[asked.lanes, asked.cut]
    speed = memory.exit_m_s[asked.lanes, asked.cut, place]
    return routes.exit_m[asked.routes, place] + trains.last_axle_m[rows], np.where(np.isfinite(speed), speed, 0.0)


@dataclass(frozen=True)
class ReadByRoute:
    """`on_stretch` on the routes that have one, `ahead` on all others."""

    ahead: AimReading
    on_stretch: ReadOnStretch

    def n_per_kn(self, asked: Asked) -> Floats:
        """See `AimReading`."""
        has = np.isfinite(self.on_stretch.stretch_m[asked.routes, 0])
        found = np.full(len(has), np.nan)
        for reading, which in ((self.on_stretch, has), (self.ahead, ~has)):
            if which.any():
                found[which] = reading.n_per_kn(asked.chosen(which))
        return found


@dataclass(frozen=True)
class ReadAhead:
    """The resistance of cuts as it is read on the free stretch ahead of the last position: by `sensors`, on the way
    that is expected of them."""

    sensors: SpeedSensors
    way: ExpectedWay

    def n_per_kn(self, asked: Asked) -> Floats:
        """Readings (n,); NaN where there is none."""
        rows = asked.lanes * self.sensors.trains.cuts + asked.cut
        speeds = self.sensors.stretch(asked, asked.position)
        taken = self.way.mean_n_per_kn[rows]
        expected = self.way.comes_m_s(rows, asked.routes, speeds, taken)
        return speeds.resistance_n_per_kn(taken, expected, self.way.gravity_m_s2[rows])


@dataclass(frozen=True)
class AimControl:
    """Commands of the last position for the cuts of `trains`, by `aim`; `reading` None: by category alone."""

    aim: HumpAim
    routes: HumpRoutes
    trains: TrainCuts
    reading: AimReading | None = None

    def command(self, asked: Asked) -> Floats:
        """Exit speeds (n,), m/s: by the free distance that the head has when the last axle leaves the position."""
        rows = asked.lanes * self.trains.cuts + asked.cut
        release = self.routes.exit_m[asked.routes, asked.position] + self.trains.last_axle_m[rows]
        reading = None if self.reading is None else self.reading.n_per_kn(asked)
        free = asked.free_m - release
        return self.aim.command_m_s(asked.routes, self.trains.category[rows], self.trains.cars[rows], free, reading)

    def expected_m_s(self, routes: Ints, category: Ints, cars: Ints, free_distance_m: Floats) -> Floats:
        """Exit speeds (n,) as they are expected before the train; see `HumpAim`."""
        return self.aim.expected_m_s(routes, category, cars, free_distance_m, self.reading is not None)
