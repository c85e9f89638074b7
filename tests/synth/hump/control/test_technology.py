"""Where misrouted cuts go, and the laws of braking."""

from __future__ import annotations

from dataclasses import replace
from math import inf, nan

import pytest

from plant_models.errors import PlantError
from synth.hump.control.brake_task import LeastInterval, ManualBraking, TableBraking, UniformBraking, ZoneBraking
from synth.hump.control.event import Why
from synth.hump.control.models import Misroute, Resistance
from synth.hump.control.practice_rules import PracticeRules
from synth.hump.control.route_table import RouteTable
from synth.hump.control.strobe import Strobe
from synth.hump.control.technology import RejectionOrCheapest, leader_track
from tests.plant_models.hump.random_humps import random_hump

LOST = Misroute(7, 1, Why.NOT_SEPARATED, 6, (4, 5, 8), 2, 5)


def test_the_follower_goes_to_the_track_of_its_leader() -> None:
    assert leader_track(LOST) == 5
    assert leader_track(replace(LOST, leader_track=1)) == 4
    assert leader_track(replace(LOST, leader=0, leader_track=None, track=8)) == 8


def test_a_rejection_track_comes_first_and_then_the_cheapest() -> None:
    prices = {4: 30.0, 5: 20.0, 8: 20.0}

    def price(track: int, belongs: int) -> float:
        assert belongs == 2
        return prices[track]

    assert RejectionOrCheapest((9, 8), price)(LOST) == 8
    assert RejectionOrCheapest((9,), price)(LOST) == 5


@pytest.mark.parametrize("seed", range(20))
def test_lists_of_the_table_are_those_of_the_routes(seed: int) -> None:
    """By brute force: each route tells the position that its track needs of each of its switches."""
    graph = random_hump(seed)
    table = RouteTable(graph)
    needed: dict[int, dict[int, int]] = {switch.number: {} for switch in graph.switches}
    for lead in graph.leads:
        for route in graph.routes(lead).values():
            for element in route.elements:
                assert route.track in table.behind[element.number]
                if element.position is not None:
                    needed[element.number][route.track] = element.position
    assert table.needed == needed


def test_strobing() -> None:
    strobe = Strobe(0.5, 8.5)
    assert strobe.holds(0.5)
    assert strobe.holds(8.5)
    assert not any(strobe.holds(speed) for speed in (0.49, 8.51, -1.0, nan, inf, -inf))
    assert [strobe.bounded(speed) for speed in (0.1, 3.0, 99.0, inf, -inf, nan)] == [0.5, 3.0, 8.5, 8.5, 0.5, 0.5]
    with pytest.raises(PlantError, match="must be less than"):
        Strobe(2.0, 2.0)


@pytest.mark.parametrize(("speed_m_s", "zone_m"), [(3.0, 24.0), (5.0, 24.0), (2.0, 12.0), (6.0, 30.0)])
def test_uniform_braking_for_the_least_interval_takes_that_much_longer(speed_m_s: float, zone_m: float) -> None:
    """By integration in small steps of path, not by the formula."""
    task = LeastInterval(1.0).task(speed_m_s, zone_m)
    steps, time_s, v2 = 100_000, 0.0, speed_m_s**2
    for _ in range(steps):
        speed = v2**0.5
        v2 -= 2.0 * 9.81e-3 * task.n_per_kn * zone_m / steps
        time_s += 2.0 * zone_m / steps / (speed + v2**0.5)
    assert time_s == pytest.approx(zone_m / speed_m_s + 1.0, abs=1e-6)


def test_a_slow_cut_is_not_stopped() -> None:
    """The strobe holds the exit speed; a cut that is slower anyway is not braked."""
    task = LeastInterval(20.0).task(2.0, 24.0)
    assert 2.0**2 - 2.0 * 9.81e-3 * task.n_per_kn * 24.0 == pytest.approx(0.25)
    assert LeastInterval(20.0).task(0.4, 24.0) == UniformBraking(0.0)


def test_tasks_and_rules_refuse_what_cannot_be() -> None:
    with pytest.raises(PlantError, match="n_per_kn"):
        UniformBraking(-1.0)
    with pytest.raises(PlantError, match="degree"):
        ZoneBraking(0.0, 10.0, 1.1, 50.0)
    with pytest.raises(PlantError, match="braking by hand"):
        ManualBraking(lambda place_m: 1e6).braking(0.0)
    with pytest.raises(PlantError, match="longest_base_m"):
        PracticeRules(longest_base_m=1.0)
    with pytest.raises(PlantError, match="usual_base_m"):
        PracticeRules(usual_base_m=31.0)


def test_a_zone_brakes_from_its_begin_to_its_end() -> None:
    task = ZoneBraking(100.0, 10.0, 0.25, 80.0)
    assert [task.braking(place) for place in (99.9, 100.0, 109.9, 110.0)] == [None, *[Resistance(20.0)] * 2, None]
    assert (ManualBraking.way, UniformBraking.way, ZoneBraking.way, TableBraking.way) == (0, 1, 2, 3)
