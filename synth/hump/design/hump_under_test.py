"""A hump as the design test takes it: its ways for single cars, its brakes as far as they are counted upon."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from plant_models.library import WeightCategories
from plant_models.rolling.random_cuts import CutPopulation
from synth.hump.configuration.design_settings import DesignSettings
from synth.hump.design_runners import DesignRunner, design_population
from synth.hump.trains.hump_routes import HumpRoutes
from synth.hump.trains.made_trial import brake_of, planner_of
from synth.hump.trains.normal_hump_position import LibraryBrake, NormalHumpPosition
from synth.hump.trains.position_roles import Roles, Spacing
from synth.hump.trains.resolved_trial import ResolvedTrial
from synth.hump.trains.route_ways import RouteWays, route_ways
from synth.hump.trains.train_plan import Planner

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
