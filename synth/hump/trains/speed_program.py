"""The program of a train before it is humped: what the locomotive and the uncoupler are told."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from synth.hump.trains.hump_routes import HumpRoutes
from synth.hump.trains.train_cuts import TrainCuts
from synth.hump.trains.train_plan import TrainPlan
from synth.hump.trains.trial import HumpTrial

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ProgramRow:
    """Cut number `cut` of the train, from 1. `time_s`, `pushed_m`: when its middle is at the crest, since that of the
    first cut was there; `exit_m_s`: of the positions of its route, the last one by the aim as it is expected."""

    cut: int
    cars: int
    axles: int
    mass_t: float
    length_m: float
    category: str
    track: int
    hump_speed_m_s: float
    time_s: float
    pushed_m: float
    exit_m_s: tuple[float, ...]


@dataclass(frozen=True)
class SpeedProgram:
    """The program of the train `number`, from 0, of a trial; `positions`: most that a route has."""

    number: int
    positions: int
    rows: tuple[ProgramRow, ...]

    @property
    def mean_m_s(self) -> float:
        """From the first cut at the crest to the last."""
        return self.rows[-1].pushed_m / self.rows[-1].time_s

    @property
    def cars_per_hour(self) -> float:
        """The same in cars, counted from middle to middle of the cuts."""
        cars = sum(row.cars for row in self.rows) - 0.5 * (self.rows[0].cars + self.rows[-1].cars)
        return 3600.0 * cars / self.rows[-1].time_s


def speed_program(trial: HumpTrial, number: int) -> SpeedProgram:
    """The program of train `number` of `trial`; nothing is humped."""
    trains, _, known, plan = trial.planned(number, 1)
    return program_of(number, trains, plan, known.aim.speed_m_s, trial.routes)


def program_of(number: int, trains: TrainCuts, plan: TrainPlan, aim_m_s: Floats, routes: HumpRoutes) -> SpeedProgram:
    """The program that `plan` has for its only train."""
    kept = np.maximum(routes.positions_of[trains.route] - 1, 0)
    aimed = routes.positions_of[trains.route] > 0
    middle = np.cumsum(trains.length_m) - 0.5 * trains.length_m
    members = trains.population.categories.members
    rows = tuple(
        ProgramRow(
            cut=cut + 1,
            cars=int(trains.cars[cut]),
            axles=int(trains.axles[cut]),
            mass_t=float(trains.mass_t[cut]),
            length_m=float(trains.length_m[cut]),
            category=members[trains.category[cut]].latin,
            track=int(trains.track[cut]),
            hump_speed_m_s=float(plan.hump_speed_m_s[0, cut]),
            time_s=float(plan.crest_s[0, cut] - plan.crest_s[0, 0]),
            pushed_m=float(middle[cut] - middle[0]),
            exit_m_s=(*plan.exit_m_s[0, cut, : kept[cut]].tolist(), *([float(aim_m_s[cut])] if aimed[cut] else [])),
        )
        for cut in range(trains.cuts)
    )
    return SpeedProgram(number, routes.positions, rows)
