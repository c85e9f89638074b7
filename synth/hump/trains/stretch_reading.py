"""The resistance of cuts as aim tables have it: mean over the stretch that the tables name, bends and air included."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.hump.trains.asked import Asked
from synth.hump.trains.free_stretch import SHORTEST_M
from synth.hump.trains.hump_routes import HumpRoutes
from synth.hump.trains.route_rolling import RouteRolling
from synth.hump.trains.speed_sensors import SpeedSensors
from synth.hump.trains.train_memory import TrainMemory


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
