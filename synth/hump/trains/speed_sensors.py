"""What the control reads of the speeds of cuts on their way, with the errors of its sensors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from plant_models.frozen_arrays import Floats
from plant_models.rolling.keyed_numbers import keyed_uniform
from plant_models.rolling.random_numbers import Purpose
from synth.hump.trains.asked import Asked
from synth.hump.trains.free_stretch import StretchSpeeds
from synth.hump.trains.hump_routes import HumpRoutes
from synth.hump.trains.train_cuts import TrainCuts

SLOWEST_M_S = 0.05
"""No reading is less."""


@dataclass(frozen=True)
class SpeedSensors:
    """Sensors at the entrance and the exit of each position: independent normal errors of `std_m_s` (assumed), one a
    cut and place, the same whoever asks. The hump speed is known without error."""

    routes: HumpRoutes
    trains: TrainCuts
    std_m_s: float = 0.1

    def stretch(self, asked: Asked, position: int) -> StretchSpeeds:
        """The free stretch ahead of `position`, which is the one asked for or one before it. What is not over when the
        control is asked is not read."""
        trains, memory, lanes, cut = self.trains, asked.memory, asked.lanes, asked.cut
        rows, now = lanes * trains.cuts + cut, asked.start.time_s
        comes = asked.start.speed_m_s
        if position < asked.position:
            place = lanes, cut, position
            comes = np.where(memory.begin_s[place] <= now, memory.entry_m_s[place], 0.0)
        ends = self.routes.entrance_m[asked.routes, position] + trains.first_axle_m[rows]
        if position == 0:
            begins, leaves, std = 0.5 * trains.length_m[rows], memory.hump_speed_m_s[lanes, cut], 0.0
        else:
            place = lanes, cut, position - 1
            begins = self.routes.exit_m[asked.routes, position - 1] + trains.last_axle_m[rows]
            left = np.where(memory.end_s[place] <= now, memory.exit_m_s[place], 0.0)
            leaves, std = self.read(asked, 2 * position - 1, left), self.std_m_s
        return StretchSpeeds(begins, leaves, ends, self.read(asked, 2 * position, comes), std, self.std_m_s)

    def read(self, asked: Asked, place: int, speed_m_s: Floats) -> Floats:
        """Readings of `speed_m_s` (n,) at the entrance (2p) or exit (2p + 1) of position p; 0 where there is none."""
        keys = self.trains.numbers[asked.lanes], np.full(len(asked.lanes), asked.cut), np.full(len(asked.lanes), place)
        z = ndtri(keyed_uniform(self.trains.seed, Purpose.SPEED_READING, keys, 1)[0])
        with np.errstate(invalid="ignore"):
            return np.where(speed_m_s > 0.0, np.maximum(speed_m_s + self.std_m_s * z, SLOWEST_M_S), 0.0)
