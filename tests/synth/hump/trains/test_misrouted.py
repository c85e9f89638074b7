"""A misrouted cut rolls as one that was sent there: on humps whose ways differ in places, positions and lengths."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plant_models.hump import HumpGraph
from synth.hump.control.train_population import TrainPopulation
from synth.hump.trains.asked import Asked
from synth.hump.trains.hump_routes import HumpRoutes, hump_routes
from synth.hump.trains.humping import Hump, humped
from synth.hump.trains.normal_hump_position import NormalHumpPosition
from synth.hump.trains.train_cuts import TrainCuts, trains
from synth.hump.trains.train_memory import TrainMemory
from tests.plant_models.hump.random_humps import random_hump
from tests.plant_models.rolling.populations import CATEGORIES, MIX, population
from tests.synth.hump.trains.made_trials import GivenHead
from tests.synth.hump.trains.rolling_cuts import route_rolling

Floats = NDArray[np.float64]

TRAINS, CUTS = 40, 2
SPEED_M_S = 2.4


@dataclass(frozen=True)
class Steady:
    """One hump speed, and exit speeds that each cut has of its own in each position."""

    speeds_m_s: Floats

    def speed(self, cut: int, memory: TrainMemory) -> Floats:
        """For all trains."""
        return np.full(len(memory.crest_s), SPEED_M_S)

    def command(self, asked: Asked) -> Floats:
        """(n,)."""
        return np.asarray(self.speeds_m_s[asked.lanes, asked.cut])


def two_cuts(routes: HumpRoutes) -> TrainCuts:
    """Short cuts to any tracks."""
    shares = {member.number: 1.0 for member in CATEGORIES.members}
    lists = TrainPopulation(MIX, CATEGORIES, shares, dict.fromkeys(routes.tracks.tolist(), 1.0), 1.3, 2)
    return trains(lists, population(), routes.routes, 3, 0, TRAINS, CUTS)


def run(routes: HumpRoutes, made: TrainCuts) -> TrainMemory:
    """Both cuts over the hump, by ideal positions."""
    rolls = route_rolling(made.population, routes.routes, made.drawn, threads=1)
    positions = tuple(NormalHumpPosition(0.0, GivenHead(3.0)) for _ in range(routes.positions))
    control = Steady(np.random.default_rng(4).uniform(2.0, 5.0, (TRAINS, CUTS)))
    free = np.tile(routes.length_m, (TRAINS, 1))
    return humped(Hump(routes, positions, rolls), made, free, control, control)


def same_as_sent(graph: HumpGraph) -> tuple[int, int]:
    """How many cuts were misrouted, and how many of these went to other positions or places than their own route has;
    each is compared with the same cut sent behind its leader."""
    routes = hump_routes(graph, graph.leads[0])
    if len(routes.routes) < 2:
        return 0, 0
    made = two_cuts(routes)
    own = run(routes, made)
    sent_to = made.route.copy()
    sent_to[1::2] = own.route[:, 1]
    sent = run(routes, replace(made, route=sent_to))
    none = routes.elements
    lost = (own.misrouted_at[:, 1] < none) & (own.contact_at[:, 1] == none) & (sent.contact_at[:, 1] == none)
    np.testing.assert_array_equal(own.route[lost, 1], own.route[lost, 0])
    for name in ("time_s", "begin_s", "entry_m_s", "exit_m_s", "end_s", "end_m", "end_speed_m_s", "free_m"):
        np.testing.assert_array_equal(getattr(own, name)[lost, 1], getattr(sent, name)[lost, 1], err_msg=name)
    was, is_now = made.route[1::2][lost], own.route[lost, 1]
    places = [routes.entrance_m, routes.length_m[:, None], np.isfinite(routes.entrance_m)]
    other = np.any([np.any(each[was] != each[is_now], axis=1) for each in places], axis=0)
    return int(lost.sum()), int(other.sum())


def test_a_misrouted_cut_is_as_one_that_was_sent_there() -> None:
    """Random humps: some have no position or element on a way at all."""
    counts = np.array([same_as_sent(random_hump(seed)) for seed in range(60)])
    assert counts[:, 0].sum() > 200
    assert counts[:, 1].sum() > 100
