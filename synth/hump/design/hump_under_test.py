"""A hump as the design test takes it: its ways for single cars, its brakes as far as they are counted upon; what its
fall gives cars that nothing brakes, and what the brakes can take from them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from plant_models.hump import Route
from plant_models.library import WeightCategories, load_car
from plant_models.rolling.random_cuts import CutPopulation
from synth.hump.configuration.sections import DesignSettings
from synth.hump.design_runners import (
    CAR,
    DesignRunner,
    RolledRoute,
    RunnerRoll,
    bad_runner,
    design_population,
    good_runner,
    roll_runners,
    speed_at,
    very_good_runner,
)
from synth.hump.planning.position_roles import Roles, Spacing
from synth.hump.planning.train_plan import Planner
from synth.hump.rolling.hump_position import LibraryBrake, NormalHumpPosition
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.rolling.route_rolling import RouteWays, route_ways
from synth.hump.trial.made_trial import brake_of, planner_of
from synth.hump.trial.resolved_trial import ResolvedTrial

MOST_COMBINATIONS: Final = 1000
"""Of exit speeds of all positions that are compared for a cut."""

MOST_CHOICES: Final = 31
"""Of them in one position."""


@dataclass(frozen=True)
class HumpUnderTest:
    """`ways`: the `routes` as cars of the `population` feel them; `brakes`: of the positions in order from the crest,
    with the share that is counted upon; `planner`: chooses exit speeds; `allowed_m_s`: at which the good runner may
    leave a position that aims."""

    asked: DesignSettings
    routes: HumpRoutes
    population: CutPopulation
    ways: RouteWays
    categories: WeightCategories
    brakes: tuple[LibraryBrake, ...]
    planner: Planner
    allowed_m_s: float

    @property
    def positions(self) -> tuple[NormalHumpPosition, ...]:
        """Models that keep every command exactly where the brake allows it."""
        return tuple(NormalHumpPosition(0.0, brake) for brake in self.brakes)

    def place_of(self, runner: DesignRunner) -> int:
        """Of its weight category."""
        return self.categories.members.index(self.categories.of(runner.mass_t))

    def heads_m(self, runner: DesignRunner) -> np.ndarray:
        """What the brake of each position is counted upon to take from `runner`, (positions,)."""
        one = np.array([runner.mass_t]), np.array([runner.axles]), np.array([self.place_of(runner)])
        return np.array([float(brake.head_m(*one)[0]) for brake in self.brakes])

    def with_choices(self, choices: int) -> HumpUnderTest:
        """The same, where so many exit speeds of each position are compared."""
        return replace(self, planner=replace(self.planner, roles=with_choices(self.planner.roles, choices)))

    @property
    def choices(self) -> int:
        """Exit speeds of a position that are compared."""
        return max((exits.range.choices for exits in spacing(self.planner.roles)), default=1)


def hump_under_test(config: ResolvedTrial) -> HumpUnderTest:
    """The hump of a trial. `InputError` for a position that the library does not have."""
    usable, roles = config.settings.exit_speeds.usable_share, config.roles
    brakes = (brake_of(each, config) for each in config.positions)
    population, free = design_population(), len(spacing(roles))
    choices = min(MOST_CHOICES, int(MOST_COMBINATIONS ** (1.0 / max(free, 1)) + 1e-9))
    return HumpUnderTest(
        asked=config.settings.design,
        routes=config.routes,
        population=population,
        ways=route_ways(population, config.routes.routes),
        categories=config.categories,
        brakes=tuple(replace(brake, share=usable * brake.share) for brake in brakes),
        planner=planner_of(config),
        allowed_m_s=config.settings.couplings.allowed_m_s,
    ).with_choices(choices)


def spacing(roles: Roles) -> tuple[Spacing, ...]:
    """The exits of the positions whose exit speeds are chosen."""
    kept = (roles.exits[place] for place in roles.not_of_all)
    return tuple(exits for exits in kept if isinstance(exits, Spacing) and exits.range.choices > 1)


def with_choices(roles: Roles, choices: int) -> Roles:
    """`roles` whose positions are compared for so many exit speeds."""
    exits = tuple(
        replace(each, range=replace(each.range, choices=choices)) if each in spacing(roles) else each
        for each in roles.exits
    )
    return replace(roles, exits=exits)


FASTEST_M_S: Final = 15.0
"""Speed at the crest up to which it is looked for what the fall lacks."""

NEARLY_M_S: Final = 1e-3


@dataclass(frozen=True)
class Fall:
    """Whether the bad runner comes `into_m` into `track`, the one where it fares worst.

    `fall_m`: from the crest to there. `left_m`: energy head that it has left there; below 0: what the fall lacks, as
    the speed head at the crest with which it would just come there. `stop_m`: where it stops, infinite for nowhere.
    """

    route: Route
    into_m: float
    fall_m: float
    left_m: float
    stop_m: float

    @property
    def needed_m(self) -> float:
        """The fall that would just do."""
        return self.fall_m - self.left_m


@dataclass(frozen=True)
class PositionNeed:
    """Position `number`, on the way on which it has least left for the very good runner, to `track`.

    `comes_m_s`: speed of the runner at its entrance where nothing brakes it. `needed_m`: energy head that it has at the
    exit, and that brakes must take so that it stops there; `there_m`: what the brakes up to there are counted upon to
    take, `own_m` of it by this position. `last`: whether no other position follows on that way.
    """

    number: int
    track: int
    comes_m_s: float
    needed_m: float
    own_m: float
    there_m: float
    last: bool

    @property
    def left_m(self) -> float:
        """Of the brake when the runner stands; below 0: what lacks."""
        return self.there_m - self.needed_m


@dataclass(frozen=True)
class Unbraked:
    """`rolls`: the very good, the good and the bad runner on the way of `fall`, for a picture."""

    fall: Fall
    positions: tuple[PositionNeed, ...]
    rolls: tuple[RunnerRoll, ...]


def unbraked(hump: HumpUnderTest) -> Unbraked:
    """Rolls of single cars without brakes, over all ways."""
    asked, speed = hump.asked, hump.asked.hump_speed_m_s
    runners = very_good_runner(asked), bad_runner(asked)
    rolled = [RolledRoute(route, *roll_runners(route, runners, speed)) for route in hump.routes.routes]
    fall = least_fall(rolled, hump)
    shown = very_good_runner(asked), good_runner(asked), bad_runner(asked)
    return Unbraked(fall, position_needs(rolled, hump), roll_runners(fall.route, shown, speed))


def least_fall(rolled: Sequence[RolledRoute], hump: HumpUnderTest) -> Fall:
    """That of the way on which the bad runner fares worst."""
    worst = min(rolled, key=lambda each: fares(each, point_m(each, hump)))
    at_m = point_m(worst, hump)
    speed = speed_at(worst.bad, at_m)
    if speed is None:
        left_m = -missing_m(worst.route, hump, at_m)
    else:
        left_m = speed**2 / (2.0 * worst.bad.runner.reduced_gravity_m_s2)
    return Fall(worst.route, at_m - worst.track_m, worst.fall_m(at_m), left_m, worst.bad.stop_m)


def point_m(rolled: RolledRoute, hump: HumpUnderTest) -> float:
    """To where the middle of the bad runner must come; on a shorter track, to its end."""
    length_m = load_car(CAR).car.length_m
    return min(rolled.track_m + hump.asked.into_track_m, rolled.route.length_m - length_m)


def fares(rolled: RolledRoute, at_m: float) -> tuple[float, float]:
    """How far the bad runner comes, up to `at_m`, and how fast it is there: less is worse."""
    return min(rolled.bad.stop_m, at_m), speed_at(rolled.bad, at_m) or 0.0


def missing_m(route: Route, hump: HumpUnderTest, at_m: float) -> float:
    """Speed head at the crest, beyond that of the test, with which the bad runner just comes to `at_m`."""
    runner = bad_runner(hump.asked)
    low, high = hump.asked.hump_speed_m_s, FASTEST_M_S
    while high - low > NEARLY_M_S:
        middle = 0.5 * (low + high)
        (roll,) = roll_runners(route, (runner,), middle)
        low, high = (low, middle) if roll.stop_m > at_m else (middle, high)
    return (high**2 - hump.asked.hump_speed_m_s**2) / (2.0 * runner.reduced_gravity_m_s2)


def position_needs(rolled: Sequence[RolledRoute], hump: HumpUnderTest) -> tuple[PositionNeed, ...]:
    """Of all positions, from the crest on, each on its worst way."""
    runner = very_good_runner(hump.asked)
    heads = hump.heads_m(runner)
    found: dict[int, list[PositionNeed]] = {}
    for row, each in enumerate(rolled):
        count = int(hump.routes.positions_of[row])
        for place in range(count):
            ends_m = hump.routes.entrance_m[row, place], hump.routes.exit_m[row, place]
            enters, leaves = (speed_at(each.good, float(at_m)) or 0.0 for at_m in ends_m)
            need = PositionNeed(
                number=place + 1,
                track=each.route.track,
                comes_m_s=enters,
                needed_m=leaves**2 / (2.0 * runner.reduced_gravity_m_s2),
                own_m=float(heads[place]),
                there_m=float(heads[: place + 1].sum()),
                last=place + 1 == count,
            )
            found.setdefault(place, []).append(need)
    return tuple(min(needs, key=lambda need: (not need.last, need.left_m)) for _, needs in sorted(found.items()))
