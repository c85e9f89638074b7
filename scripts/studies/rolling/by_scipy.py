"""The equation of motion of one cut in time, written from docs/explanation/rolling.md axle by axle; solved by scipy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from plant_models.rolling.random_cuts import DrawnCuts
from plant_models.rolling.roll_track import RollTrack

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
