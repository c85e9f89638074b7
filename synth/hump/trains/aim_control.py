"""The control of the last position: the exit speed that aims each cut at the standing cars of its track."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models.frozen_arrays import Floats, Ints
from synth.hump.trains.asked import Asked
from synth.hump.trains.expected_way import ExpectedWay
from synth.hump.trains.hump_aim import HumpAim
from synth.hump.trains.hump_routes import HumpRoutes
from synth.hump.trains.speed_sensors import SpeedSensors
from synth.hump.trains.stretch_reading import AimReading
from synth.hump.trains.train_cuts import TrainCuts


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
