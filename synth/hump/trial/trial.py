"""A trial: all that trains over a hump depend on, and the trains themselves, batch by batch."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from plant_models.cut import GRAVITY_M_S2, ROTATING_MASS_PER_AXLE_T
from plant_models.errors import require
from plant_models.frozen_arrays import Floats, Ints
from synth.hump.configuration.sections import CouplingLimits
from synth.hump.configuration.settings import TracksSettings
from synth.hump.planning.aim_control import AimControl, AimReading, HumpAim, ReadAhead, ReadByRoute, ReadOnStretch
from synth.hump.planning.forecast import Given
from synth.hump.planning.free_stretch import ExpectedWay, SpeedSensors
from synth.hump.planning.interval_control import Feedback, FeedbackSpeeds, OpenLoop, ProgramSpeeds
from synth.hump.planning.known_cuts import BAD, KnownCuts, known_cuts, runner_n_per_kn
from synth.hump.planning.rollability import Rollability, mean_of_category, measured_rollability
from synth.hump.planning.train_plan import Planner, TrainPlan
from synth.hump.rolling.hump_position import HumpPosition
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.rolling.humping import Hump, humped
from synth.hump.rolling.list_trains import TrainSource
from synth.hump.rolling.outcomes import USUAL_COUPLINGS, PassLimits, TrainOutcomes, in_order, outcomes
from synth.hump.rolling.route_rolling import RouteRolling, RouteWays, rolling_on
from synth.hump.rolling.train_cuts import TrainCuts, expected
from synth.hump.rolling.train_memory import ExitSpeeds, HumpSpeeds, TrainMemory
from synth.hump.trial.tracks_between import Tracks, free_before_m, tracks_as_drawn, tracks_left

USUAL_TRACKS = TracksSettings()

WORST_ENTRY_M_S = 1.0
"""Assumed: bad runners against the wind come to the last position with this at least."""

USUAL_M_S = 4.0
"""Speed at which the wind is counted in that."""

BATCH = 250
"""Shifts that are humped side by side; no figure depends on it."""

BrakeHead = Callable[[Floats, Ints, Ints], Floats]
"""Energy head (rows,), metres, that a position can take from cuts, by mass, axles and category."""


@dataclass(frozen=True)
class Sensing:
    """What the control measures of cuts on their way: speeds at both ends of every free stretch (`SpeedSensors`).

    `for_aim`, `for_intervals`: what the resistance so read is used for.
    """

    speed_std_m_s: float = 0.1
    for_aim: bool = True
    for_intervals: bool = True


@dataclass(frozen=True)
class Control:
    """`feedback`: exit speeds of the interval positions are chosen when a cut comes; else as planned before the train.

    `sensing` None: the resistance of a cut is that of its category. `slow_down_s`: a feedback slows the train down for
    a cut that would come closer than this to those ahead of it; None: never.
    """

    feedback: bool = True
    sensing: Sensing | None = None
    slow_down_s: float | None = None


@dataclass(frozen=True)
class Turn:
    """Some trains side by side, each on its own tracks, with their plan and all that happened to them."""

    trains: TrainCuts
    tracks: Tracks
    plan: TrainPlan
    memory: TrainMemory


@dataclass(frozen=True)
class HumpTrial:
    """Trains from `source` over `routes`, whose `ways` are the routes as their cars feel them.

    `positions`: models in order from the crest, of every route that has so many; `planner` has their roles; `tracks`:
    where cars stand before each train, or before the first one of each shift, and skates. `aim`: exit speeds of the
    positions that aim, by route; `usable_heads_m`: what each position can be trusted to take from cuts; `full_heads_m`:
    what it takes at mean friction. `couplings`: which couplings are too fast.
    """

    source: TrainSource
    routes: HumpRoutes
    ways: RouteWays
    positions: tuple[HumpPosition, ...]
    planner: Planner
    control: Control
    aim: HumpAim
    usable_heads_m: tuple[BrakeHead, ...]
    full_heads_m: tuple[BrakeHead, ...]
    threads: int = 0
    couplings: CouplingLimits = USUAL_COUPLINGS
    tracks: TracksSettings = USUAL_TRACKS

    def __post_init__(self) -> None:
        require(
            len(self.positions) == self.routes.positions == len(self.planner.roles.exits),
            f"hump trial: {len(self.positions)} position models and {len(self.planner.roles.exits)} roles; the hump "
            f"has {self.routes.positions} positions",
        )

    def batch(self, first: int, count: int) -> TrainOutcomes:
        """What the trains `first` … `first + count − 1`, which are whole shifts, come to."""
        turns = [self.outcomes(each.trains, each.memory) for each in self.turns(first, count)]
        return in_order(turns)

    def outcomes(self, trains: TrainCuts, memory: TrainMemory) -> TrainOutcomes:
        """What trains came to that were humped here."""
        able = self.able(trains, memory.route.ravel())
        return outcomes(self.routes, trains, memory, able, self.couplings, self.tracks.shift_trains)

    def able(self, trains: TrainCuts, route: Ints) -> PassLimits:
        """What the positions can do with the cuts of `trains`, which went on `route` (rows,)."""
        roles, category = self.planner.roles, trains.category
        heads = [brake(trains.mass_t, trains.axles, category) for brake in self.full_heads_m]
        aim = self.aim.lowest_by_table_m_s[self.aim.group[route], category]
        lowest = [
            np.where(aims[route], aim, exits.lowest_m_s) for exits, aims in zip(roles.exits, roles.aims, strict=True)
        ]
        braked = 2.0 * reduced_gravity_m_s2(trains)[:, None] * np.stack(heads, axis=1)
        return PassLimits(np.stack(lowest, axis=1), braked)

    def humped(self, first: int, count: int) -> tuple[TrainCuts, TrainPlan, TrainMemory]:
        """Trains with their plan and all that happened to them; each begins a shift of its own."""
        trains = self.source.trains(first, count)
        turn = self.turn(trains, self.first_tracks(trains))
        return turn.trains, turn.plan, turn.memory

    def turns(self, first: int, count: int) -> Iterator[Turn]:
        """The trains `first` … `first + count − 1`: those that begin a shift side by side, then those behind them, …

        They are whole shifts, or the beginning of one.
        """
        drawn, of_shift = self.source.trains(first, count), self.tracks.shift_trains
        trains = drawn.every(of_shift)
        turn = self.turn(trains, self.first_tracks(trains))
        yield turn
        for place in range(1, min(of_shift, count)):
            trains = drawn.every(of_shift, place)
            turn = self.turn(trains, self.tracks_behind(turn, trains))
            yield turn

    def train(self, number: int) -> tuple[TrainCuts, Tracks]:
        """The train `number` and the tracks that it finds; for these, the trains of its shift before it are humped."""
        trains, place = self.source.trains(number, 1), number % self.tracks.shift_trains
        if place == 0:
            return trains, self.first_tracks(trains)
        *_, before = self.turns(number - place, place)
        return trains, self.tracks_behind(before, trains)

    def tracks_behind(self, turn: Turn, coming: TrainCuts) -> Tracks:
        """The tracks that the trains find which are `coming` behind those of `turn`."""
        return tracks_left(self.routes, turn.tracks, turn.memory, turn.trains, coming, self.tracks.pulled_from_share)

    def first_tracks(self, trains: TrainCuts) -> Tracks:
        """The tracks that `trains` find which begin a shift."""
        numbers = trains.numbers
        count = int(numbers[-1]) + 1 - trains.first
        free_m = free_before_m(self.tracks, self.routes, trains.seed, trains.first, count)
        return tracks_as_drawn(self.routes, trains, free_m[:: trains.apart])

    def turn(self, trains: TrainCuts, tracks: Tracks) -> Turn:
        """What becomes of `trains` that find these `tracks`."""
        known, rolls = self.known(trains, tracks.free_m), self.rolls_of(trains)
        plan = self.planner.plan(known)
        hump = self.hump_for(rolls)
        control = self.control_of(trains, known, plan, self.aim_of(trains, known, rolls))
        speeds: HumpSpeeds = ProgramSpeeds(plan.hump_speed_m_s)
        if self.control.slow_down_s is not None and isinstance(control, Feedback):
            speeds = FeedbackSpeeds(control, self.control.slow_down_s)
        memory = humped(hump, trains, tracks.free_m, speeds, control)
        memory.pushed_up, memory.pulled = tracks.pushed_up.sum(axis=1), tracks.pulled.sum(axis=1)
        return Turn(trains, tracks, plan, memory)

    def rolls_of(self, trains: TrainCuts) -> RouteRolling:
        """How the cuts of `trains` roll."""
        return rolling_on(self.ways, trains.population, trains.drawn, self.threads)

    def hump_for(self, rolls: RouteRolling) -> Hump:
        """The hump for the trains whose `rolls` these are."""
        aimed, left = self.planner.roles.aims.any(axis=0), np.sqrt(1.0 - self.tracks.skates_share)
        return Hump(self.routes, self.positions, rolls, np.where(aimed, 1.0, left))

    def known(self, trains: TrainCuts, free_m: Floats) -> KnownCuts:
        """What is known of trains before they are humped, and how they will be aimed if tracks stay as they are."""
        release = self.routes.release_m[trains.route] + trains.last_axle_m
        lanes = np.repeat(np.arange(trains.trains), trains.cuts)
        free = free_m[lanes, trains.route] - release
        sensing = self.control.sensing
        measured = sensing is not None and sensing.for_aim
        aim = self.aim.expected_m_s(trains.route, trains.category, trains.cars, free, measured)
        gravity = reduced_gravity_m_s2(trains)
        heads = [brake(trains.mass_t, trains.axles, trains.category) for brake in self.usable_heads_m]
        braked = 2.0 * gravity[:, None] * np.stack(heads, axis=1)
        least = np.sqrt(WORST_ENTRY_M_S**2 + 2.0 * gravity * self.worse_head_m(trains))
        last = self.routes.positions_of[trains.route] - 1
        given = Given(aim, np.sqrt(aim**2 + braked[np.arange(len(trains)), last]), least)
        return known_cuts(trains, self.ways, given, braked, self.threads)

    def worse_head_m(self, trains: TrainCuts) -> Floats:
        """Energy head (rows,) that bad runners against the wind lose more than expected ahead of the last position."""
        rows, last = np.arange(len(self.routes.routes)), self.routes.positions_of - 1
        begins = np.where(last > 0, self.routes.exit_m[rows, np.maximum(last - 1, 0)], 0.0)
        stretch = np.where(last >= 0, self.routes.entrance_m[rows, last] - begins, 0.0)[trains.route]
        drawn = expected(trains)
        weather = trains.population.weather
        wind = np.array([weather.head_wind_mean_m_s, weather.head_wind_mean_m_s + 2.0 * weather.head_wind_std_m_s])
        against = (USUAL_M_S + wind) * np.abs(USUAL_M_S + wind)
        worse = runner_n_per_kn(trains, drawn, BAD) - drawn.resistance_n_per_kn
        return np.asarray(1e-3 * stretch * (worse + drawn.air_n_per_kn * (against[1] - against[0])))

    def aim_of(self, trains: TrainCuts, known: KnownCuts, rolls: RouteRolling) -> AimControl:
        """The control of positions that aim for these trains, which roll as in `rolls`."""
        sensing, stretch_m = self.control.sensing, self.aim.stretch_m
        reading: AimReading | None = None
        if sensing is not None and sensing.for_aim:
            sensors = SpeedSensors(self.routes, trains, sensing.speed_std_m_s)
            reading = ReadAhead(sensors, expected_way(trains, known))
            if stretch_m is not None and np.isfinite(stretch_m).any():
                reading = ReadByRoute(reading, ReadOnStretch(sensors, rolls, stretch_m))
        return AimControl(self.aim, self.routes, trains, reading)

    def control_of(self, trains: TrainCuts, known: KnownCuts, plan: TrainPlan, aim: AimControl) -> ExitSpeeds:
        """The control of all positions for these trains."""
        if not self.control.feedback:
            return OpenLoop(plan, self.planner.roles, aim)
        sensing = self.control.sensing
        rollability: Rollability = partial(mean_of_category, known)
        if sensing is not None and sensing.for_intervals:
            sensors = SpeedSensors(self.routes, trains, sensing.speed_std_m_s)
            rollability = measured_rollability(sensors, trains, expected_way(trains, known)).resistance_n_per_kn
        return Feedback(self.planner, known, plan, rollability, aim)


def expected_way(trains: TrainCuts, known: KnownCuts) -> ExpectedWay:
    """The way of `trains` as it is expected before the train."""
    return ExpectedWay(known.rolls, known.mean_n_per_kn, reduced_gravity_m_s2(trains))


def reduced_gravity_m_s2(trains: TrainCuts) -> Floats:
    """g' of each cut by its list, (rows,)."""
    return np.asarray(GRAVITY_M_S2 / (1.0 + ROTATING_MASS_PER_AXLE_T * trains.axles / trains.mass_t))
