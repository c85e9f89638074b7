"""The same rolls beside the kernel: in numpy, all cuts at once, as a careful user would write them; and the equation of
motion of one cut in time, written from docs/explanation/rolling.md axle by axle and solved by scipy.

Those in numpy are written from the equations of that page without a look at the kernel: Heun's rule in the energy,
steps of one length, falls by interpolation in a table for each type of car.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from plant_models.rolling.random_cuts import CutPopulation, DrawnCuts
from plant_models.rolling.roll_track import RollTrack

TABLE_M = 0.25
"""Distance of the table's places."""


class NumpyRoll:
    """Cuts on a track, ready to roll by numpy."""

    def __init__(self, population: CutPopulation, track: RollTrack, yard_from_m: float, drawn: DrawnCuts) -> None:
        self.drawn, self.bends = drawn, track.bends
        self.linear = population.law.linear_n_per_kn
        longest = drawn.car_lengths_m.sum(axis=1).max()
        self.places = np.arange(-longest, track.end_m + longest, TABLE_M)
        self.falls = []
        for mixed in drawn.mix.cars:
            car = mixed.car
            behind = (car.length_m - car.axle_offsets_m[-1]) / 2.0 + np.array(car.axle_offsets_m)
            axles = self.places[:, None] - behind
            lost = population.law.slope_extra_n_per_kn * np.clip(axles, 0.0, yard_from_m)
            lost += population.weather.snow_n_per_kn * np.maximum(axles - yard_from_m, 0.0)
            self.falls.append((track.fall_m(axles) - 1e-3 * lost).mean(axis=1))
        self.of_type = [drawn.types == kind for kind in range(len(self.falls))]
        self.middles = drawn.car_fronts_m + 0.5 * drawn.car_lengths_m
        self.g, self.w0 = drawn.reduced_gravity_m_s2, drawn.resistance_n_per_kn

    def fall(self, head: Floats) -> Floats:
        """Of each cut, (n,)."""
        front = head[:, None] - self.drawn.car_fronts_m
        every = np.zeros_like(front)
        for fall, those in zip(self.falls, self.of_type, strict=True):
            every[those] = np.interp(front[those], self.places, fall)
        return np.asarray((self.drawn.shares * every).sum(axis=1))

    def bend_heads(self, head: Floats, h: Floats) -> tuple[Floats, Floats]:
        """(Per (m/s)², whatever the speed) on the way from `head` to `head` + `h`, each (n,)."""
        v2, whatever = np.zeros_like(head), np.zeros_like(head)
        for b, bend in enumerate(self.bends):
            middle = head[:, None] - self.middles
            if not np.any((middle + h[:, None] > bend.from_m) & (middle < bend.to_m)):
                continue
            low, high = np.maximum(middle, bend.from_m), np.minimum(middle + h[:, None], bend.to_m)
            part = (self.drawn.shares * np.maximum(high - low, 0.0)).sum(axis=1) / (bend.to_m - bend.from_m)
            v2 += part * self.drawn.bend_v2_m_s2[:, b]
            whatever += part * self.drawn.bend_head_m[:, b]
        return v2, whatever

    def lost(self, e: Floats, h: Floats, bend_v2: Floats) -> Floats:
        """Head that depends on the speed, by the energy `e`, on `h` metres."""
        v = np.sqrt(2.0 * np.maximum(e, 0.0))
        against = v + self.drawn.head_wind_m_s
        force = self.linear * v + self.drawn.air_n_per_kn * against * np.abs(against)
        return np.asarray(1e-3 * h * force + bend_v2 * v * v)

    def on(self, start_m: Floats, speed_m_s: Floats, end_m: Floats, step_m: float) -> tuple[Floats, Floats]:
        """(Speed at `end_m`, stop), 0 behind a stop and infinite without one."""
        steps = math.ceil(float((end_m - start_m).max()) / step_m)
        h, x, e = (end_m - start_m) / steps, start_m.copy(), 0.5 * speed_m_s**2
        stop, fall = np.where(e > 0.0, np.inf, x), self.fall(x)
        for _ in range(steps):
            beyond, (v2, head) = self.fall(x + h), self.bend_heads(x, h)
            steady = beyond - fall - head - 1e-3 * h * self.w0
            here = self.lost(e, h, v2)
            there = self.lost(e + self.g * (steady - here), h, v2)
            later = e + self.g * (steady - 0.5 * (here + there))
            stops = np.isinf(stop) & (later <= 0.0)
            stop[stops] = (x + h * e / np.where(stops, e - later, 1.0))[stops]
            x, e, fall = x + h, np.where(np.isinf(stop), later, 0.0), beyond
        return np.sqrt(2.0 * e), stop

    def back(self, arrival_m: Floats, speed_m_s: float, start_m: Floats, step_m: float) -> Floats:
        """The highest speed at `start_m` of a cut that has at most `speed_m_s` at `arrival_m`."""
        steps = math.ceil(float((arrival_m - start_m).max()) / step_m)
        h, x, e = (arrival_m - start_m) / steps, arrival_m.copy(), np.full(len(start_m), 0.5 * speed_m_s**2)
        fall = self.fall(x)
        for _ in range(steps):
            before, (v2, head) = self.fall(x - h), self.bend_heads(x - h, h)
            steady = fall - before - head - 1e-3 * h * self.w0
            here = self.lost(e, h, v2)
            there = self.lost(e - self.g * (steady - here), h, v2)
            x, e, fall = x - h, np.maximum(e - self.g * (steady - 0.5 * (here + there)), 0.0), before
        return np.asarray(np.sqrt(2.0 * e))


LONGEST_S = 5000.0


@dataclass(frozen=True)
class Accuracy:
    """What is asked of scipy; steps are limited because it does not know where grades change."""

    relative: float
    absolute: float
    longest_step_s: float


TIGHT, LOOSE = Accuracy(1e-8, 1e-9, 0.2), Accuracy(1e-5, 1e-6, 2.0)


@frozen_arrays
class Motion:
    """Speeds and times at stations, 0 and infinite behind a stop; the stop, infinite without one."""

    speed_m_s: Floats
    time_s: Floats
    stop_m: float


def acceleration(
    drawn: DrawnCuts, i: int, track: RollTrack, linear: float, extra: Callable[[Floats], Floats]
) -> Callable[[float, float], float]:
    """a(x, v) of cut `i` with its head at `x`; `extra`: resistance at an axle, N/kN."""
    mass, cars = drawn.mass_t[i], [drawn.mix.cars[t].car for t in drawn.types[i]]
    fronts = np.concatenate(([0.0], np.cumsum([car.length_m for car in cars])))
    behind, weight = [], []
    for j, car in enumerate(cars):
        overhang = (car.length_m - car.axle_offsets_m[-1]) / 2.0
        behind += [fronts[j] + overhang + a for a in car.axle_offsets_m]
        weight += [mass[j] / mass.sum() / len(car.axle_offsets_m)] * len(car.axle_offsets_m)
    axles, shares = np.array(behind), np.array(weight)
    middles = 0.5 * (fronts[1:] + fronts[:-1])
    starts, grades = np.array(track.profile.starts_m), np.array(track.profile.grades_permille)
    gravity = 9.81 / (1.0 + 0.42 * len(axles) / mass.sum())
    w0 = float((mass * drawn.basic_n_per_kn[i]).sum() / mass.sum())
    air, wind = float(drawn.air_n_per_kn[i]), float(drawn.head_wind_m_s[i])
    bends = [(b.from_m, b.to_m, b.to_m - b.from_m) for b in track.bends]

    def a(x: float, v: float) -> float:
        at = x - axles
        grade = np.where(at < 0.0, 0.0, grades[np.clip(np.searchsorted(starts, at, side="right") - 1, 0, None)])
        drive = float((shares * (grade - extra(at))).sum())
        turned = 0.0
        for (begins, ends, length), v2, head in zip(bends, drawn.bend_v2_m_s2[i], drawn.bend_head_m[i], strict=True):
            inside = (x - middles >= begins) & (x - middles < ends)
            turned += 1e3 * (v2 * v * v + head) / length * float((mass * inside).sum() / mass.sum())
        against = v + wind
        return float(gravity * 1e-3 * (drive - w0 - linear * v - air * against * abs(against) - turned))

    return a


def solved(
    a: Callable[[float, float], float],
    start_m: float,
    speed_m_s: float,
    stations_m: Floats,
    accuracy: Accuracy = TIGHT,
) -> Motion:
    """The roll from `start_m` over `stations_m`, to a stop or to the last of them."""
    from scipy.integrate import solve_ivp  # start-up: scipy only where it is needed

    def stops(_: float, y: Floats) -> float:
        return float(y[1])

    def passes(station: float) -> Callable[[float, Floats], float]:
        def event(_: float, y: Floats) -> float:
            return float(y[0] - station)

        return event

    events = [stops, *map(passes, stations_m.tolist())]
    for event, last in ((events[0], -1.0), (events[-1], 1.0)):
        event.terminal, event.direction = True, last  # type: ignore[attr-defined]
    found = solve_ivp(
        lambda _, y: (y[1], a(y[0], y[1])), (0.0, LONGEST_S), (start_m, speed_m_s), "RK45", events=events,
        rtol=accuracy.relative, atol=accuracy.absolute, max_step=accuracy.longest_step_s,
    )  # fmt: skip
    assert found.status == 1, found.message
    assert found.t_events is not None
    assert found.y_events is not None
    speed, time = np.zeros(len(stations_m)), np.full(len(stations_m), np.inf)
    for k, (t, y) in enumerate(zip(found.t_events[1:], found.y_events[1:], strict=True)):
        if len(t):
            time[k], speed[k] = t[0], y[0][1]
    stopped = len(found.t_events[0]) > 0
    return Motion(speed, time, float(found.y_events[0][0][0]) if stopped else np.inf)
