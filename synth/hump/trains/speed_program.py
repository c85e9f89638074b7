"""The program of a train before it is humped: what the locomotive, the uncoupler and the hump operator are told, as a
table and a sentence; and the command `hump speed`, which humps nothing.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.frame.command import Asked, Command, Head, Steps, Work
from synth.frame.exhibits import Chapter, Chart, Column, Exhibit, Row, Sentence, Table
from synth.frame.printed_numbers import decimals
from synth.hump.configuration.trial_file import TrialFile, parse_trial_file, trial_text
from synth.hump.options import SpeedOptions
from synth.hump.planning.position_roles import Roles
from synth.hump.planning.train_plan import TrainPlan
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.trial.asked_trial import MODEL_ONLY, NO_SAFETY, AskedTrial, asked_trial
from synth.hump.trial.made_trial import made_trial
from synth.hump.trial.trial import HumpTrial
from synth.kernels.cache import guarded
from tuning_tables.json_text import canonical_json

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from synth.hump.trains.train_trace import TrainTrace


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


HOW_TO_READ: Final = (
    "The locomotive has the hump speed when the middle of a cut is at the crest; in between it changes evenly. Time "
    "and metres count from the first cut. Exit speeds are those planned for the positions on the way of the cut; the "
    "last one aims, by what is expected of the cut."
)
PUSHED: Final = (
    "Speed at which the train is pushed when the middle of each cut is at the crest; in between it changes evenly."
)
COLUMNS: Final = (
    Column("cut", "cut"),
    Column("cars", "cars"),
    Column("axles", "axles", spare=3),
    Column("mass_t", "mass", "t", decimals(1), spare=3),
    Column("length_m", "length", "m", decimals(2), spare=3),
    Column("category", "category", words=True, spare=2),
    Column("track", "track"),
    Column("track_name", "name of the track", words=True),
    Column("hump_speed_m_s", "hump speed", "m/s", decimals(2)),
    Column("time_s", "time", "s", decimals(1)),
    Column("pushed_m", "pushed", "m", decimals(2), spare=2),
)


def program_exhibits(program: SpeedProgram, brief: bool) -> Iterator[Exhibit]:
    """Of the whole train, and of each cut; `brief`: a terminal tells of the train, too."""
    told = {
        "train": program.number + 1,
        "planned_hump_speed_m_s": program.mean_m_s,
        "planned_cars_per_hour": program.cars_per_hour,
    }
    yield Sentence(
        f"train {program.number + 1}: cuts: {len(program.rows)}; over the crest in {program.rows[-1].time_s:.0f} s at "
        f"{program.mean_m_s:.2f} m/s, {program.cars_per_hour:.0f} cars an hour",
        told,
        brief=brief,
    )
    exits = tuple(
        Column(exit_key(place), f"exit speed {place}", "m/s", decimals(2), spare=1)
        for place in range(1, program.positions + 1)
    )
    title = f"Program of train {program.number + 1}"
    yield Table("program", title, (*COLUMNS, *exits), [row_of(each) for each in program.rows])
    yield Sentence(HOW_TO_READ)


def exit_key(place: int) -> str:
    """The column of the exit speed of a position, 1 being the first behind the crest."""
    return f"exit_{place}_m_s"


def row_of(row: ProgramRow) -> Row:
    """What is to be done with one cut; positions that are not on its way have nothing."""
    exits = {exit_key(place): speed for place, speed in enumerate(row.exit_m_s, start=1)}
    return {column.key: getattr(row, column.key) for column in COLUMNS} | exits


def planned_chart(program: SpeedProgram) -> Chart:
    """The hump speeds that are planned; times since the first cut was at the crest."""
    return chart_of(program.number, lambda: [(row.time_s, row.hump_speed_m_s, row.length_m) for row in program.rows])


def pushed_chart(number: int, traced: Callable[[], TrainTrace]) -> Chart:
    """The hump speeds that the train had, which a control may have slowed down."""
    return chart_of(number, lambda: [(cut.crest_s, cut.hump_speed_m_s, cut.length_m) for cut in traced().cuts])


def chart_of(number: int, pushed: Callable[[], Sequence[tuple[float, float, float]]]) -> Chart:
    """The picture of the train `number`, from 0; `pushed`: when each cut is at the crest, how fast, and its length."""

    def drawn() -> Figure:
        from synth.hump.trains.pictures.train_speeds import PushedTrain, hump_speed_program

        return hump_speed_program(PushedTrain(number, *map(np.array, zip(*pushed(), strict=True))))

    return Chart("hump-speed-program", f"Hump speed program of train {number + 1}", PUSHED, drawn)


LIMITS_OF_USE = (
    "A plan expects of each cut what is usual of its weight category, and brakes each position evenly along the path; "
    "how such trains fare is told by hump simulate.",
    MODEL_ONLY,
    NO_SAFETY,
)


@dataclass(frozen=True)
class AskedProgram:
    """The program of the train `number`, from 0, of a trial."""

    trial: AskedTrial
    number: int


def resolve(asked: Asked[TrialFile, SpeedOptions]) -> AskedProgram:
    """The trial with what was typed, and the train that is planned."""
    return AskedProgram(asked_trial(asked.settings, asked.options), asked.options.train - 1)


def head(asked: AskedProgram) -> Head:
    """What is said of it."""
    config = asked.trial.config
    depends = {"train": asked.number + 1, "trial": json.loads(config.trains_json)}
    title = f"Program of train {asked.number + 1}: {config.title}"
    return asked.trial.head(title, canonical_json(depends).decode("utf-8"))


def compute(asked: AskedProgram, work: Work) -> SpeedProgram:
    """The program."""
    program = guarded(speed_program, guarded(made_trial, asked.trial.config), asked.number)
    work.progress.done(f"train {asked.number + 1}: {len(program.rows)} cuts")
    return program


def show(program: SpeedProgram) -> Iterator[Chapter]:
    """What is shown of it."""
    yield Chapter("Program", (*program_exhibits(program, brief=True), planned_chart(program)))


COMMAND = Command(
    name="hump speed",
    read=parse_trial_file,
    options=SpeedOptions,
    resolve=resolve,
    head=head,
    steps=lambda asked: Steps(1, "planning", "trains"),
    compute=compute,
    show=show,
    limits_of_use=LIMITS_OF_USE,
    text=trial_text,
)
