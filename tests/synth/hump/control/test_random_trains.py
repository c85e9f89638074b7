"""Many trains: what never happens, and how fast the control is.

Random trains with random faults on random humps: what must never happen, and what the counters find.

Every example is a hump, a train and faults of its own. `judged_trains` humps 100 000 of them by hand.
Humps of 2ⁿ tracks: a switch, a retarder behind the first and the second one, and a park retarder on every track.
The control is far faster than the hump, and its work grows no faster than cuts and axles do.
"""

from __future__ import annotations

import time
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plant_models.hump import Branch, Edge, HumpGraph, Retarder, Signal, Switch, TrackSection, Vertex
from synth.hump.control.axle_counters import AxleCounters
from synth.hump.control.cut_record import CutRecord, Mark
from synth.hump.control.cut_routes import Misrouting, RouteTable
from synth.hump.control.events import Kind
from tests.effort import sized
from tests.synth.hump.control.judged_trains import SCENES, Humping, Scene, judgement, random_humping
from tests.synth.hump.control.made_trains import axle_places, humped, record
from tests.synth.hump.control.queue_of_cuts import APART_M
from tests.synth.hump.control.reference_sections import LateSwitch, MovingCut

SEEDS = st.integers(0, 2**32 - 1)
NEVER = ("thrown under", "thrown beside", "lost", "silent counters", "other states")
CATCH_UPS = ("catch-ups missed", "catch-ups false")
UNCOUPLINGS = ("wrong uncouplings missed", "wrong uncouplings false")


@pytest.mark.requirement("HUMP-01", "HUMP-04", "HUMP-06")
@pytest.mark.parametrize("name", SCENES)
@settings(max_examples=sized(10, 40))
@given(seed=SEEDS)
def test_what_must_never_happen_does_not_and_right_sensors_find_all(name: str, seed: int) -> None:
    """No points under or beside a cut, none lost, no silent counter, and the log replays. With right sensors none is
    missed and none is false; a gap in which a cut stalls tells nothing, so there uncouplings are not judged."""
    scene = SCENES[name]
    judged = judgement(random_humping(seed, scene))
    none: tuple[str, ...] = NEVER
    if scene.faults == 0 or scene.points_alone:
        none += CATCH_UPS if scene.stalled_share else CATCH_UPS + UNCOUPLINGS
    assert {key: judged[key] for key in none} == dict.fromkeys(none, 0)
    assert judged["cuts"] > 0


@pytest.mark.parametrize(("name", "seed"), [("all", 49094), ("stalled, all", 24757)])
def test_cars_that_rolled_with_the_cut_ahead_past_late_points_are_not_lost(name: str, seed: int) -> None:
    """These trains had a cut of which some cars ended on another track without a record."""
    humping = random_humping(seed, SCENES[name])
    assert [type(fault) for fault in humping.faults] == [LateSwitch]
    assert {key: judgement(humping)[key] for key in NEVER} == dict.fromkeys(NEVER, 0)


def total(scene: Scene, trains: int = 40) -> dict[str, int]:
    """Sums over some trains."""
    judged = [judgement(random_humping(seed, scene)) for seed in range(trains)]
    return {key: sum(each[key] for each in judged) for key in judged[0]}


def test_the_trains_are_no_easy_ones() -> None:
    """There are catch-ups, wrong uncouplings, misrouted cuts, long cars and faults among them."""
    counted = total(Scene(faults=3, wrong_share=0.15))
    least = {"catch-ups": 100, "wrong uncouplings": 10, "misrouted": 30, "faults": 30}
    assert all(counted[key] >= number for key, number in least.items()), counted
    humpings = [random_humping(seed, Scene()) for seed in range(20)]
    assert any(Mark.LONG_BASE in humping.cuts[0].marks for humping in humpings)
    assert any(len({cut.lead for cut in humping.cuts}) == 2 for humping in humpings)


def test_without_counters_points_are_thrown_under_cuts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(AxleCounters, "is_clear", lambda self, element: True)
    assert total(Scene(faults=3))["thrown under"] > 0


def test_cuts_stall_in_the_trains_and_objects_never_overlap() -> None:
    stalled = stood = 0
    for seed in range(40):
        humping = random_humping(seed, SCENES["stalled"])
        stalled += humping.stalled
        for ahead, behind in pairwise(humping.objects):
            if ahead.lead != behind.lead:
                continue
            times = np.union1d(ahead.times_s, behind.times_s)
            gaps = np.array([ahead.place_m(t) - ahead.axles_m[-1] - behind.place_m(t) for t in times])
            # A table begins at the crest, and ends behind all joints or where its object stands.
            assert np.all(gaps[(times >= behind.times_s[0]) & (times <= ahead.times_s[-1])] > 0.0)
            if ahead.places_m[-1] < max(each.places_m[-1] for each in humping.objects if each.lead == ahead.lead):
                stood += 1
                assert behind.places_m[-1] <= ahead.places_m[-1] - ahead.axles_m[-1] - APART_M + 1e-9
    assert (stalled > 20, stood > 5) == (True, True), (stalled, stood)


def test_cuts_whose_misrouting_is_not_recorded_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Misrouting, "send", lambda self, cut, element, why, reachable, leader=0: ())
    monkeypatch.setattr(AxleCounters, "off_route", lambda self: {})
    assert total(Scene(faults=3, points_alone=True))["lost"] > 0


def test_a_missed_and_an_invented_catch_up_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    humping = random_humping(4, Scene())
    true, told = humping.catch_ups()
    assert true == told != set()
    monkeypatch.setattr(Humping, "told", frozenset({(Kind.CATCH_UP, 9, 9, 0.0)}))
    judged = judgement(humping)
    assert (judged["catch-ups missed"], judged["catch-ups false"]) == (len(true), 1)


def edge(to: int | None, length_m: float) -> Edge:
    return Edge(to, length_m, ((0.0, 5.0),))


class Building:
    """Numbers are given in the order of building."""

    def __init__(self) -> None:
        self.switches, self.retarders, self.tracks = 0, 400, 0
        self.vertices: list[Vertex] = []

    def retarder(self, to: int) -> int:
        self.retarders += 1
        zones = ((0.0, 12.0),)
        self.vertices.append(
            Retarder(self.retarders, edge(to, 40.0), zones, 2.0, 14.0, "knp-5-bunch", exit_std_m_s=0.15)
        )
        return self.retarders

    def grow(self, levels: int, below: int) -> int:
        """The first element of what has so many levels of switches, below so many."""
        if levels == 0:
            self.tracks += 1
            self.vertices.append(TrackSection(600 + self.tracks, edge(None, 600.0), 600.0, self.tracks))
            return self.retarder(600 + self.tracks)
        self.switches += 1
        number = self.switches
        left, right = (Branch(edge(self.grow(levels - 1, below + 1), 32.0), 4.73, 27.0) for _ in range(2))
        self.vertices.append(Switch(number, left, right, 6.0, 5.0, 0.6, 0.2))
        return self.retarder(number) if below in (1, 2) else number


def full_hump(levels: int) -> HumpGraph:
    """2 to the power of `levels` tracks."""
    building = Building()
    first = building.grow(levels, 0)
    return HumpGraph((*building.vertices, Signal(201, edge(first, 42.0))), (201,))


LEAST_TIMES = 2000.0


def dense_train(table: RouteTable, cuts: int) -> tuple[list[CutRecord], list[MovingCut]]:
    """Cuts of two cars that follow each other as densely as 2.7 m/s over the crest gives, 5 m/s behind it."""
    random = np.random.default_rng(1)
    train = [record(n, int(random.choice(table.graph.tracks)), 2) for n in range(1, cuts + 1)]
    axles, places = axle_places(2), np.array([0.0, 1000.0])
    starts = [cut.serial * cut.length_m / 2.7 for cut in train]
    return train, [
        MovingCut(cut.serial, axles.copy(), np.array([start, start + 200.0]), places.copy())
        for cut, start in zip(train, starts, strict=True)
    ]


def test_it_is_2000_times_faster_than_the_hump() -> None:
    """32 tracks, 40 cuts, ticks of 0.1 s; the track of the tests is in the time."""
    table = RouteTable(full_hump(5))
    train, objects = dense_train(table, 40)
    best = float("inf")
    for _ in range(3):
        begin = time.process_time()
        control, _ = humped(table, train, objects)
        best = min(best, time.process_time() - begin)
    assert len(control.state.arrived) == 40
    assert control.events[-1].time_s / best > LEAST_TIMES


def test_the_log_grows_with_the_cuts_and_the_switches_of_a_route() -> None:
    """The log, which is what the control does, grows with the cuts; tracks add a switch a doubling."""

    def lines(levels: int, cuts: int) -> int:
        table = RouteTable(full_hump(levels))
        return len(humped(table, *dense_train(table, cuts))[0].events)

    assert lines(5, 80) <= 4.1 * lines(5, 20)
    assert lines(6, 40) <= 1.3 * lines(5, 40)
