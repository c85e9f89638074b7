"""Trials of humps, whose every part a test may choose: positions of a given error, and an aim by distance alone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from plant_models.hump import HumpGraph
from plant_models.library import WeightCategories, load_weight_categories
from plant_models.library.hump_entry import load_hump
from plant_models.rolling.resistance_law import HumpNormLaw, ResistanceLaw
from plant_models.rolling.roll_track import Weather
from synth.hump.configuration.settings import TracksSettings
from synth.hump.control.train_population import TrainPopulation
from synth.hump.planning.aim_control import CategoryAim, HumpAim
from synth.hump.planning.forecast import SpeedRange
from synth.hump.planning.known_cuts import KnownCuts
from synth.hump.planning.position_roles import Roles, Spacing
from synth.hump.planning.speed_rules import HumpSpeedLimits, SpeedMethod, whole_train
from synth.hump.planning.train_plan import Planner, TrainPlan
from synth.hump.rolling.hump_position import Arrivals, NormalHumpPosition
from synth.hump.rolling.hump_routes import HumpRoutes, hump_routes
from synth.hump.rolling.list_trains import TrainSource
from synth.hump.rolling.route_rolling import route_ways
from synth.hump.trial.trial import Control, HumpTrial
from tests.plant_models.rolling.populations import MIX, population
from tuning_tables.aim import AimAxes
from tuning_tables.aim.axes import aim_grid

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

CATEGORIES: WeightCategories = load_weight_categories()
STEPS_M_S = tuple(np.round(np.arange(1.2, 3.25, 0.2), 3).tolist())
RANGES = (SpeedRange(3.0, 6.5, 5), SpeedRange(2.5, 6.0, 5))
UNUSED = SpeedRange(1.0, 1.0, 1)
"""Of the last position, which aims all cuts."""


@dataclass(frozen=True)
class GivenHead:
    """A full brake that takes one energy head from every cut."""

    head_m: float

    def __call__(self, arrivals: Arrivals) -> Floats:
        """Metres."""
        return np.full(len(arrivals), self.head_m)


@dataclass(frozen=True)
class UsableHead:
    """What an aim counts on."""

    head_m: float

    def __call__(self, mass_t: Floats, axles: Ints, category: Ints) -> Floats:
        """Metres."""
        return np.full(len(mass_t), self.head_m)


@dataclass(frozen=True)
class ConstantPlanner(Planner):
    """Pushes all cuts at `speed_m_s`, whatever steps there are."""

    speed_m_s: float = 1.7

    def plan(self, known: KnownCuts) -> TrainPlan:
        """See `Planner`."""
        return self.at_speeds(known, np.full((known.trains, known.cuts), self.speed_m_s))


def even_aim(routes: HumpRoutes, near_m_s: float, far_m_s: float) -> HumpAim:
    """Commands all cuts exit speeds that rise evenly with 1000 m of free distance."""
    axes = AimAxes(np.array([1, 2]), np.linspace(0.0, 1000.0, 101))
    grid = aim_grid(axes, np.tile(np.linspace(near_m_s, far_m_s, 101), (2, 1)))
    tables = (tuple(CategoryAim(grid) for _ in CATEGORIES.members),)
    return HumpAim(np.zeros(len(routes.routes), dtype=np.int64), tables, 0.5)


@dataclass(frozen=True)
class Day:
    """What a trial is made for: cars of cuts, weather and law, the error of positions, how the hump is run."""

    cuts: int = 8
    cars_mean: float = 1.8
    most_cars: int = 4
    tracks: Mapping[int, float] | None = None
    weather: Weather = field(default_factory=lambda: Weather(10.0, 0.5, 3.0))
    law: ResistanceLaw = field(default_factory=HumpNormLaw)
    std_m_s: float = 0.15
    aim_m_s: float = 1.4
    aim_far_m_s: float | None = None
    steps_m_s: tuple[float, ...] = STEPS_M_S
    acceleration_m_s2: float = 0.05
    control: Control = field(default_factory=Control)
    constant_m_s: float | None = None
    method: SpeedMethod = whole_train
    standing: TracksSettings = field(default_factory=TracksSettings)
    worst_pair: bool = False
    heads_m: tuple[float, ...] = (2.4, 2.4, 1.5)
    ranges: tuple[SpeedRange, ...] = RANGES
    seed: int = 5
    threads: int = 1

    def on(self, hump: str | HumpGraph = "large", lead: int | None = None) -> HumpTrial:
        """The trial on a hump of the library, or a graph."""
        graph = load_hump(hump).graph if isinstance(hump, str) else hump
        routes = hump_routes(graph, graph.leads[0] if lead is None else lead)
        people = population(MIX, self.law, self.weather)
        tracks = self.tracks or dict.fromkeys(routes.tracks.tolist(), 1.0)
        shares = {member.number: 1.0 for member in CATEGORIES.members}
        lists = TrainPopulation(MIX, CATEGORIES, shares, tracks, self.cars_mean, self.most_cars)
        own = routes.positions
        numbers = np.arange(1, own + 1)[:, None]
        last, held = routes.positions_of == numbers, routes.positions_of >= numbers
        roles = Roles(tuple(Spacing(each) for each in (*self.ranges[: own - 1], UNUSED)), last, held)
        limits = HumpSpeedLimits(self.steps_m_s, self.acceleration_m_s2)
        planner = Planner(routes, limits, roles, worst_pair=self.worst_pair, method=self.method)
        if self.constant_m_s is not None:
            planner = ConstantPlanner(**vars(planner), speed_m_s=self.constant_m_s)
        heads = (*self.heads_m[: own - 1], self.heads_m[-1])
        return HumpTrial(
            source=TrainSource(lists, people, routes.routes, self.seed, self.cuts),
            routes=routes,
            ways=route_ways(people, routes.routes, MIX),
            positions=tuple(NormalHumpPosition(self.std_m_s, GivenHead(head)) for head in heads),
            planner=planner,
            control=self.control,
            aim=even_aim(routes, self.aim_m_s, self.aim_far_m_s or self.aim_m_s),
            usable_heads_m=tuple(UsableHead(0.8 * head) for head in heads),
            full_heads_m=tuple(UsableHead(head) for head in heads),
            tracks=self.standing,
            threads=self.threads,
        )

    def but(self, **changes: object) -> Day:
        """The same but for `changes`."""
        return replace(self, **changes)  # type: ignore[arg-type]  # of its own fields
