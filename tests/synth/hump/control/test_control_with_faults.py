"""Control of the small hump of `test_hump_control` with points, sections or counters at fault, or without counters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from plant_models.errors import PlantError
from plant_models.hump import HumpGraph, Signal
from synth.hump.control.cut_record import CutRecord, Mark
from synth.hump.control.cut_routes import RouteTable
from synth.hump.control.events import Block, Kind, Why
from synth.hump.control.hump_control import HumpControl, Operation
from synth.hump.control.models import ENTRY, PUBLISHED_MODEL, PracticeRules
from tests.plant_models.hump.random_humps import small_vertices
from tests.synth.hump.control.made_trains import (
    LONG_M,
    TABLE,
    axle_places,
    close_pair,
    commands,
    humped,
    record,
    rolling,
    told,
)
from tests.synth.hump.control.reference_sections import (
    CounterSlip,
    FalselyFree,
    FalselyOccupied,
    Fault,
    LateSwitch,
    MovingCut,
    StuckSwitch,
    moving_cut,
)
from tests.synth.hump.control.reference_track import ReferenceTrack


@pytest.mark.requirement("HUMP-04")
def test_a_catch_up_is_told_by_the_counters_too() -> None:
    assert next((e.element, e.cut, e.value) for e in told(close_pair(), Kind.CATCH_UP)) == (1, 2, 1)


@pytest.mark.requirement("HUMP-04")
def test_a_stuck_switch_misroutes_a_cut_and_tells_where_and_why() -> None:
    """Switch 2 lies left and does not move: cut 1 to track 3 goes to track 2."""
    control, _ = humped(TABLE, [record(1, 3)], [rolling(1, 5.0)], [StuckSwitch(2, 0.0, 100.0)])
    assert [(e.element, e.cut, e.value) for e in told(control, Kind.MISROUTED)] == [(2, 1, Why.WRONG_POSITION)]
    assert control.state.arrived == {1: [2]}


def test_points_that_did_not_obey_are_commanded_again_for_the_next_cut() -> None:
    """Switch 2 is stuck at the first command alone: cut 1 to track 3 goes to track 2, cut 2 to track 3."""
    cuts = [record(1, 3), record(2, 3)]
    control, _ = humped(TABLE, cuts, [rolling(1, 5.0), rolling(2, 40.0)], [StuckSwitch(2, 0.0, 1.0)])
    assert control.state.arrived == {1: [2], 2: [3]}
    assert [(cut, position) for switch, cut, position in commands(control) if switch == 2] == [(1, 1.0), (2, 1.0)]


def test_a_late_switch_that_still_comes_in_time_misroutes_nobody() -> None:
    """Cut 1 comes on the section at 6.8 s and to the points at 8 s; they were commanded at 0 s."""
    for extra_s, track, why in ((6.2, 2, []), (7.8, 1, [Why.OFF_ROUTE])):
        control, truth = humped(TABLE, [record(1, 2)], [rolling(1, 0.0)], [LateSwitch(1, extra_s)])
        assert control.state.arrived == {1: [track]}
        assert [e.value for e in told(control, Kind.MISROUTED)] == why
        assert [each[1:] for each in truth.truth.moved_under] == [(1, 0)] * len(why)


def long_car(operation: Operation, faults: Sequence[FalselyFree] = ()) -> tuple[HumpControl, ReferenceTrack]:
    """A car with 18.65 m between its bogies over sections of 18 m, and a cut to the other side behind it."""
    cuts = [record(1, 2, marks=frozenset({Mark.LONG_BASE})), record(2, 1)]
    return humped(TABLE, cuts, [rolling(1, 0.0, 2.0, base_m=LONG_M), rolling(2, 45.0)], faults, operation)


def test_a_long_car_over_a_short_section_is_held_by_the_counters_alone() -> None:
    control, track = long_car(Operation())
    assert not track.truth.thrown_under
    assert next((e.element, e.cut, e.value) for e in told(control, Kind.BLOCKED)) == (1, 2, Block.COUNTERS)
    assert control.state.arrived == {1: [2], 2: [1]}
    _, track = long_car(Operation(rules=PUBLISHED_MODEL))
    assert [(switch, number) for _, switch, number in track.truth.thrown_under] == [(1, 0)]


@pytest.mark.requirement("HUMP-01")
def test_a_falsely_free_section_throws_no_points_under_a_cut() -> None:
    """Cut 1 is on switch 1 from 6.8 s to 12.5 s; the section is told free from 7 s on."""

    def throws(rules: PracticeRules) -> list[tuple[int, int]]:
        cuts, objects = [record(1, 2), record(2, 1)], [rolling(1, 0.0), rolling(2, 20.0)]
        _, track = humped(TABLE, cuts, objects, [FalselyFree(1, 7.0, 12.0)], Operation(rules=rules))
        return [(switch, number) for _, switch, number in track.truth.thrown_under]

    assert throws(PracticeRules()) == []
    assert throws(PUBLISHED_MODEL) == [(1, 0)]


def test_no_points_are_thrown_under_a_cut_that_stands_with_one_axle_on_a_falsely_free_section() -> None:
    """Cut 2, to the other side, comes before cut 1 has left, and stands with its first axle 0.5 m behind the joint."""
    places, times = np.array([0.0, 34.0, 34.5, 34.51, 500.0]), np.array([5.2, 12.0, 12.1, 52.1, 150.0])
    stands = MovingCut(2, axle_places(1), times, places)
    cuts = [record(1, 2), record(2, 1)]
    control, track = humped(TABLE, cuts, [rolling(1, 0.0), stands], [FalselyFree(1, 10.0, 80.0)])
    assert not track.truth.thrown_under
    assert 2 in control.state.misrouted
    assert {event.element for event in told(control, Kind.COUNTER_FAULT)} == {1}


def test_two_faults_of_one_section_can_deceive() -> None:
    """The limit of the rule: free by its circuit, and empty by a counter that counted the third axle twice."""
    cuts, objects = [record(1, 2), record(2, 1)], [rolling(1, 0.0, 2.5), rolling(2, 30.0)]
    faults: list[Fault] = [FalselyFree(1, 14.0, 30.0), CounterSlip(1, 1, 2, 1)]
    _, track = humped(TABLE, cuts, objects, faults)
    assert [(switch, number) for _, switch, number in track.truth.thrown_under] == [(1, 0)]
    for fault in faults:
        assert not humped(TABLE, cuts, objects, [fault])[1].truth.thrown_under


@pytest.mark.requirement("HUMP-01")
def test_points_are_not_thrown_beside_a_cut_that_stands_short_of_the_fouling_point() -> None:
    """Cut 1 creeps from 60 m to 70 m; its last axle is then at 59.5 m, the fouling points of switch 1 are at 67 m."""
    stands = moving_cut(1, axle_places(1).tolist(), 0.0, [(60.0, 5.0), (70.0, 0.5)])
    cuts = [record(1, 2), record(2, 1)]
    control, _ = humped(TABLE, cuts, [stands, rolling(2, 30.0)])
    assert [(e.element, e.cut, e.value) for e in told(control, Kind.BLOCKED)] == [(1, 2, Block.FOULED)]
    assert (1, 2, 0) not in commands(control)
    free, _ = humped(TABLE, cuts, [stands, rolling(2, 30.0)], (), Operation(rules=PUBLISHED_MODEL))
    assert (1, 2, 0) in commands(free)


def test_a_falsely_occupied_switch_stays_and_the_cut_goes_where_it_lies() -> None:
    """Switch 1 is told occupied until 40 s, though cut 1 has left it at 12.5 s, and cut 2, to the other side, later."""
    cuts, objects = [record(1, 2), record(2, 1), record(3, 1)], [rolling(1, 0.0), rolling(2, 20.0), rolling(3, 40.0)]
    control, track = humped(TABLE, cuts, objects, [FalselyOccupied(1, 12.0, 40.0)])
    assert [e.element for e in told(control, Kind.UNKNOWN_OBJECT)] == [1, 1]
    assert control.state.misrouted == {2}
    assert track.truth.ends[2] == 601


def test_a_counter_that_missed_an_axle_is_put_right_when_the_next_section_counted_the_cut() -> None:
    """The exit counter of switch 1 misses the last axle of cut 1; cut 2 goes right nevertheless."""
    cuts: list[CutRecord] = [record(1, 2), record(2, 1)]
    for end, axle in ((1, 3), (ENTRY, 2)):
        control, _ = humped(TABLE, cuts, [rolling(1, 0.0), rolling(2, 40.0)], [CounterSlip(1, end, axle, -1)])
        fault = told(control, Kind.COUNTER_FAULT)
        assert [(e.element, e.cut, e.value) for e in fault] == [(1, 1, 1.0 if end == 1 else -1.0)] or end == ENTRY
        assert control.state.arrived == {1: [2], 2: [1]}
        assert not control.counters.left_over()


def bare(*numbers: int) -> RouteTable:
    """The small hump without the counters of some elements."""
    vertices = [
        v if isinstance(v, Signal) or v.number not in numbers else replace(v, axle_counters=False)
        for v in small_vertices()
    ]
    return RouteTable(HumpGraph(tuple(vertices), (201,)))


def test_records_pass_over_sections_without_counters() -> None:
    """The retarder between two switches has none, nor has track 2."""
    cuts = [record(1, 2), record(2, 3), record(3, 1)]
    control, _ = humped(bare(401, 602), cuts, [rolling(n, 12.0 * n) for n in range(1, 4)])
    assert not control.state.alarms
    assert {e.element for e in told(control, Kind.ENTRY_COUNTER)} == {1, 2, 601, 603}
    assert control.state.arrived == {1: [2], 2: [3], 3: [1]}


def test_rules_that_need_counters_are_refused_where_a_switch_has_none() -> None:
    table = bare(2)
    with pytest.raises(PlantError, match="switch 2 has no axle counters"):
        humped(table, [record(1, 2)], [rolling(1, 0.0)])
    control, _ = humped(table, [record(1, 2)], [rolling(1, 0.0)], (), Operation(rules=PUBLISHED_MODEL))
    assert not control.state.alarms
    assert control.state.counters == {}
