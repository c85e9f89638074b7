"""The free stretch ahead of a position: from the exit of the position before it, or from the crest, to its entrance;
what the control reads of speeds there, with the errors of its sensors, and the way as it expects it.

The speeds at both ends tell the resistance of a cut on the way: w = w' + (v'² − v²)/(2 g' L), where the cut would come
with v' if it rolled with w', mean bends and mean wind. So what grades, bends and air take by expectation is taken out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtri

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from plant_models.rolling.random_numbers import Purpose, keyed_uniform
from synth.aim.knowledge import MOST_N_PER_KN, TrueReadings
from synth.aim.scene import SceneCuts
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.rolling.motion import Rolls
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import Asked
from synth.simulation.free_roll import RollingCuts

SHORTEST_M = 10.0
"""Between the places of a head; on less the errors of the speeds hide the resistance."""


@frozen_arrays
class StretchSpeeds:
    """Speeds of n cuts at both ends of a free stretch, (n,) each, and where their heads are then.

    `from_std_m_s`, `to_std_m_s`: standard deviations of the errors of both.
    """

    from_m: Floats
    from_m_s: Floats
    to_m: Floats
    to_m_s: Floats
    from_std_m_s: float
    to_std_m_s: float

    @property
    def length_m(self) -> Floats:
        """L, (n,)."""
        return self.to_m - self.from_m

    @property
    def tells(self) -> Bools:
        """Where the stretch is long enough, and both speeds were read."""
        return (self.length_m >= SHORTEST_M) & (self.from_m_s > 0.0) & (self.to_m_s > 0.0)

    def resistance_n_per_kn(self, taken_n_per_kn: Floats, expected_m_s: Floats, gravity_m_s2: Floats) -> Floats:
        """w of cuts that would come with `expected_m_s` if they rolled with `taken_n_per_kn`; NaN where it is not told,
        and where they would stop."""
        with np.errstate(divide="ignore", invalid="ignore"):
            lost = (expected_m_s**2 - self.to_m_s**2) / (2.0 * gravity_m_s2 * self.length_m)
        return np.where(self.tells & (expected_m_s > 0.0), taken_n_per_kn + 1e3 * lost, np.nan)

    def std_n_per_kn(self, gravity_m_s2: Floats) -> Floats:
        """Standard deviation of w from the errors of both speeds, (n,)."""
        speeds = np.hypot(self.from_std_m_s * self.from_m_s, self.to_std_m_s * self.to_m_s)
        return np.asarray(1e3 * speeds / (gravity_m_s2 * np.maximum(self.length_m, SHORTEST_M)))


@dataclass(frozen=True)
class ResistanceOnStretch:
    """Reading of the cuts of a scene: w on the free stretch, from speeds with errors of `speed_std_m_s`.

    `from_m`: the exit of the position before, where a cut is when its last axle is there; None: the crest, where its
    middle is there and its speed is known without error. The entrance is that of the scene, as is the law of the first
    speed. w' is the mean of the cuts.
    """

    from_m: float | None
    speed_std_m_s: float

    def of(self, cuts: SceneCuts) -> TrueReadings:
        """w, N/kN; `MOST_N_PER_KN` for a cut that stopped there."""
        mean = mean_cuts(cuts)
        speeds = self.speeds(cuts)
        gravity = cuts.rolling.cuts.reduced_gravity_m_s2
        taken = np.full(len(cuts), mean_resistance_n_per_kn(cuts))
        expected = mean.roll_on(speeds.from_m, speeds.from_m_s, speeds.to_m[:, None]).speed_m_s[:, 0]
        value = speeds.resistance_n_per_kn(taken, expected, gravity)
        return TrueReadings(np.where(np.isnan(value), MOST_N_PER_KN, value), speeds.std_n_per_kn(gravity))

    def speeds(self, cuts: SceneCuts) -> StretchSpeeds:
        """True speeds at both ends."""
        drawn, scene = cuts.rolling.cuts, cuts.scene
        begin = 0.5 * drawn.car_lengths_m.sum(axis=1) if self.from_m is None else self.from_m + drawn.last_axle_m
        end = np.maximum(scene.entrance_m + drawn.first_axle_m, begin)
        comes = cuts.rolling.roll_on(begin, cuts.stretch_speed_m_s, end[:, None]).speed_m_s[:, 0]
        begins_std = 0.0 if self.from_m is None else self.speed_std_m_s
        return StretchSpeeds(begin, cuts.stretch_speed_m_s, end, comes, begins_std, self.speed_std_m_s)


def mean_resistance_n_per_kn(cuts: SceneCuts) -> float:
    """Mean w0 of the cuts of a scene."""
    return float(cuts.rolling.cuts.resistance_n_per_kn.mean())


def mean_cuts(cuts: SceneCuts) -> RollingCuts:
    """The same cuts with the mean w0, mean bends and the mean wind of them all."""
    arrays, count = cuts.rolling.arrays, len(cuts)
    wind = np.full_like(arrays.wind_m_s, cuts.scene.population.weather.head_wind_mean_m_s)
    constant = np.full_like(arrays.constant, 1e-3 * mean_resistance_n_per_kn(cuts))

    def of_all(held: Floats) -> Floats:
        return np.repeat(held[:, :count].mean(axis=1, keepdims=True), held.shape[1], axis=1)

    bend_v2, bend_head = of_all(arrays.bend_v2), of_all(arrays.bend_head)
    mean = arrays._replace(constant=constant, wind_m_s=wind, bend_v2=bend_v2, bend_head=bend_head)
    return replace(cuts.rolling, arrays=mean)


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


@frozen_arrays
class ExpectedWay:
    """All cuts of some trains: `rolls` with mean bends and wind, their mean w0 `mean_n_per_kn` and g' (rows,)."""

    rolls: Rolls
    mean_n_per_kn: Floats
    gravity_m_s2: Floats

    def comes_m_s(self, rows: Ints, routes: Ints, speeds: StretchSpeeds, taken_n_per_kn: Floats) -> Floats:
        """Speed (n,) at the end of a stretch with `taken_n_per_kn` instead of the cuts' own; 0 where they stop, and
        where the stretch tells nothing."""
        tells = speeds.tells
        comes = np.zeros(len(rows))
        if tells.any():
            rolled = self.rolls.roll_on(
                rows[tells],
                routes[tells],
                speeds.from_m[tells],
                speeds.from_m_s[tells],
                speeds.to_m[tells, None],
                taken_n_per_kn[tells],
            )
            comes[tells] = rolled.speed_m_s[:, 0]
        return comes
