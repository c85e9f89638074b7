"""The program of a train before it is humped: what the locomotive and the uncoupler are told."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.hump.trains.hump_routes import HumpRoutes
from synth.hump.trains.position_roles import Roles
from synth.hump.trains.train_cuts import TrainCuts
from synth.hump.trains.train_plan import TrainPlan
from synth.hump.trains.trial import HumpTrial


@dataclass(frozen=True)
class ProgramRow:
    """Cut number `cut` of the train, from 1. `time_s`, `pushed_m`: when its middle is at the crest, since that of the
    first cut was there; `exit_m_s`: of the positions of its route, of one that aims as it is expected."""

    cut: int
    cars: int
    axles: int
    mass_t: float
    length_m: float
    category: str
    track: int
    track_name: str | None
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


def speed_program(trial: HumpTrial, number: int, plan: TrainPlan | None = None) -> SpeedProgram:
    """The program of train `number` of `trial`, whose `plan` may be known already; it is not humped."""
    trains, tracks = trial.train(number)
    known = trial.known(trains, tracks.free_m)
    plan = trial.planner.plan(known) if plan is None else plan
    exits = planned_m_s(trains, plan, known.aim.speed_m_s, trial.planner.roles)
    return program_of(number, trains, plan, exits, trial.routes)


def planned_m_s(trains: TrainCuts, plan: TrainPlan, aim_m_s: Floats, roles: Roles) -> Floats:
    """What the positions are to be commanded for the cuts of the only train of `plan`, (cuts, positions)."""
    found = plan.exit_m_s[0].copy()
    for position, exits in enumerate(roles.exits):
        fixed = exits.fixed_m_s(trains.category)
        kept = found[:, position] if fixed is None else fixed
        found[:, position] = np.where(roles.aims[position][trains.route], aim_m_s, kept)
    return np.asarray(found)


def program_of(number: int, trains: TrainCuts, plan: TrainPlan, exit_m_s: Floats, routes: HumpRoutes) -> SpeedProgram:
    """The program that `plan` has for its only train, whose positions are to be commanded `exit_m_s`."""
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
            track_name=routes.graph.track_names.get(int(trains.track[cut])),
            hump_speed_m_s=float(plan.hump_speed_m_s[0, cut]),
            time_s=float(plan.crest_s[0, cut] - plan.crest_s[0, 0]),
            pushed_m=float(middle[cut] - middle[0]),
            exit_m_s=tuple(exit_m_s[cut, : routes.positions_of[trains.route[cut]]].tolist()),
        )
        for cut in range(trains.cuts)
    )
    return SpeedProgram(number, routes.positions, rows)
