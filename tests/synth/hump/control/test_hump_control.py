"""The rules of the published model and of S0, one by one, on the small hump.

Signal 201, switch 1 (points at 40 m, section 34 to 52 m), left track 1, right retarder 401 (section 98 to 128 m) and
switch 2 (points at 160 m, section 154 to 172 m) before tracks 2 and 3. A throw takes 0.8 s.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from plant_models.errors import PlantError
from plant_models.hump import HumpGraph, Signal
from synth.hump.control.brake_task import ManualBraking, TableBraking, UniformBraking, ZoneBraking
from synth.hump.control.cut_motion import MovingCut, moving_cut
from synth.hump.control.cut_record import CutRecord, Mark
from synth.hump.control.event import Aspect, Block, Event, Kind, Why
from synth.hump.control.hump_control import HumpControl, Operation
from synth.hump.control.models import ENTRY, ExitSpeed, Misroute, Resistance
from synth.hump.control.practice_rules import PUBLISHED_MODEL, PracticeRules
from synth.hump.control.reference_faults import (
    CounterSlip,
    FalselyFree,
    FalselyOccupied,
    Fault,
    LateSwitch,
    StuckSwitch,
)
from synth.hump.control.reference_track import ReferenceTrack
from synth.hump.control.route_store import RouteStore
from synth.hump.control.route_table import RouteTable
from synth.hump.control.sorting_list import SortingList
from tests.plant_models.hump.random_humps import small_hump, small_vertices
from tests.synth.hump.control.made_trains import LONG_M, axle_places, humped, record

TABLE = RouteTable(small_hump())


def rolling(cut: int, start_s: float, speed_m_s: float = 5.0, cars: int = 1, base_m: float = 8.65) -> MovingCut:
    """A cut of constant speed."""
    return moving_cut(cut, axle_places(cars, base_m).tolist(), start_s, [(500.0, speed_m_s)])


def told(control: HumpControl, *kinds: Kind) -> list[Event]:
    """The events of some kinds."""
    return [event for event in control.log.events if event.kind in kinds]


def commands(control: HumpControl) -> list[tuple[int, int, float]]:
    """(switch, cut, position) of every throw."""
    return [(event.element, event.cut, event.value) for event in told(control, Kind.COMMANDED)]


def test_a_switch_is_set_for_the_next_cut_over_it_as_soon_as_it_is_free() -> None:
    """Cuts to tracks 1, 3, 1, 2: switch 2 is set for cut 2 at once, and for cut 4 when cut 2 has left it."""
    cuts = [record(1, 1), record(2, 3), record(3, 1), record(4, 2)]
    control, track = humped(TABLE, cuts, [rolling(n, 12.0 * n) for n in range(1, 5)])
    assert commands(control) == [(1, 1, 0), (2, 2, 1), (1, 2, 1), (1, 3, 0), (1, 4, 1), (2, 4, 0)]
    freed = [event for event in told(control, Kind.FREED, Kind.COMMANDED) if event.element == 2]
    assert [(event.kind, event.cut) for event in freed] == [
        (Kind.COMMANDED, 2), (Kind.FREED, 2), (Kind.COMMANDED, 4), (Kind.FREED, 4),
    ]  # fmt: skip
    assert freed[1].time_s == freed[2].time_s
    # Cut 2 passes the exit joint at 172 m with its last axle, 10.5 m behind the first, at 24 + 182.5/5 s.
    assert freed[1].time_s == pytest.approx(24.0 + 182.5 / 5.0, abs=0.1)
    assert control.state.arrived == {1: [1], 2: [3], 3: [1], 4: [2]}
    assert not control.state.alarms
    assert track.truth.ends == {0: 601, 1: 603, 2: 601, 3: 602}


def test_cuts_that_are_not_to_be_humped_are_left_out() -> None:
    cuts = [record(1, 1), record(2, 2, marks=frozenset({Mark.DO_NOT_HUMP})), record(3, 3)]
    control, _ = humped(TABLE, cuts, [rolling(1, 0.0), rolling(3, 12.0)])
    assert [cut.serial for cut in control.store.cuts] == [1, 3]
    assert control.state.arrived == {1: [1], 3: [3]}


def test_the_signal_shows_hump_until_the_last_cut_is_on_the_first_section() -> None:
    control, track = humped(TABLE, [record(1, 1), record(2, 2)], [rolling(1, 0.0), rolling(2, 12.0)])
    first, second = told(control, Kind.SIGNAL)
    assert (first.time_s, first.value) == (0.0, Aspect.HUMP)
    # The first section begins at 34 m.
    assert second.time_s == pytest.approx(12.0 + 34.0 / 5.0, abs=0.1)
    assert second.value == Aspect.STOP
    assert track.aspects == {201: Aspect.STOP}


def close_pair(operation: Operation | None = None) -> HumpControl:
    """Cut 1 to track 2; cut 2 to track 1 comes on switch 1, 21 m behind it, before cut 1 has left it."""
    control, _ = humped(
        TABLE, [record(1, 2), record(2, 1)], [rolling(1, 0.0, 2.5), rolling(2, 8.5, 2.5)], (), operation
    )
    return control


def test_a_cut_on_an_occupied_switch_follows_its_leader_and_the_switch_stays() -> None:
    control = close_pair(Operation(rules=PUBLISHED_MODEL))
    assert next((e.element, e.cut, e.value) for e in told(control, Kind.NOT_SEPARATED)) == (1, 2, 1)
    assert (1, 2, 0) not in commands(control)
    assert [(e.element, e.cut, e.value) for e in told(control, Kind.RE_ROUTED)] == [(1, 2, 2)]
    assert [(e.element, e.cut, e.value) for e in told(control, Kind.MISROUTED)] == [(1, 2, Why.NOT_SEPARATED)]
    assert control.state.arrived == {1: [2], 2: [2]}


def test_a_catch_up_is_told_by_the_counters_too() -> None:
    assert next((e.element, e.cut, e.value) for e in told(close_pair(), Kind.CATCH_UP)) == (1, 2, 1)


def test_a_follower_is_braked_on_the_next_retarder_for_the_least_interval() -> None:
    """Uniform braking from 2.5 m/s over 24 m, 2 s longer: v₂ = 48/(9.6 + 2) − 2.5 m/s, w = (v² − v₂²)/(2·g·24)."""
    control = close_pair()
    task = control.retarders.task(401, 2)
    assert isinstance(task, UniformBraking)
    assert task.n_per_kn == pytest.approx((2.5**2 - (48.0 / 11.6 - 2.5) ** 2) * 1e3 / (2.0 * 9.81 * 24.0))
    braked = told(control, Kind.BRAKED, Kind.RELEASED)
    assert [(e.element, e.cut, e.value) for e in braked if e.kind is Kind.BRAKED] == [(401, 2, task.n_per_kn)]


class LastInReach:
    """A trainer's own rule."""

    def __init__(self) -> None:
        self.asked: list[Misroute] = []

    def track_for(self, misroute: Misroute) -> int:
        """The last track that can be reached."""
        self.asked.append(misroute)
        return misroute.reachable[-1]


def test_another_technology_may_decide_where_a_follower_goes() -> None:
    technology = LastInReach()
    control = close_pair(Operation(technology))
    assert technology.asked[0] == Misroute(2, 1, Why.NOT_SEPARATED, 1, (2, 3), 1, 2)
    assert [(e.element, e.cut, e.value) for e in told(control, Kind.RE_ROUTED)][:1] == [(1, 2, 3)]


def test_a_technology_that_names_a_track_out_of_reach_is_refused() -> None:
    class Elsewhere:
        def track_for(self, misroute: Misroute) -> int:
            return 1

    with pytest.raises(PlantError, match="track 1 for cut 2 cannot be reached from element 1; it must be one of 2, 3"):
        close_pair(Operation(Elsewhere()))


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


def test_a_switch_by_hand_stays_until_it_is_thrown_by_hand() -> None:
    track = ReferenceTrack(TABLE, [rolling(1, 0.0), rolling(2, 30.0)])
    control = HumpControl(TABLE, SortingList((record(1, 1), record(2, 2))), track)
    control.switches.set_automatic(1, False)
    for tick in range(200):
        control.tick(0.1 * tick)
    blocked = [(e.cut, e.value) for e in told(control, Kind.BLOCKED) if e.element == 1]
    assert blocked == [(1, Block.BY_HAND), (2, Block.BY_HAND)]
    assert control.switches.throw_by_hand(1, 1)
    for tick in range(200, 900):
        control.tick(0.1 * tick)
        if control.state.occupant(1):
            assert not control.switches.throw_by_hand(1, 0)
    control.switches.set_automatic(1, True)
    assert not control.switches.throw_by_hand(1, 1)
    assert control.state.arrived == {1: [1], 2: [2]}


@pytest.mark.parametrize(
    ("task", "told_n"),
    [
        (UniformBraking(30.0), Resistance(30.0)),
        (ZoneBraking(100.0, 24.0, 0.5, 80.0), Resistance(40.0)),
        (TableBraking(2.5), ExitSpeed(2.5)),
        (ManualBraking(lambda place_m: 12.0 if place_m > 110.0 else None), Resistance(12.0)),
    ],
)
def test_a_retarder_brakes_as_its_task_says(task: UniformBraking, told_n: Resistance | ExitSpeed) -> None:
    control, track = humped(TABLE, [record(1, 2)], [rolling(1, 0.0)], (), Operation(tasks={(401, 1): task}))
    braked = told(control, Kind.BRAKED, Kind.RELEASED)
    assert [e.value for e in braked if e.kind is Kind.BRAKED] == [told_n[0]]
    assert track.braking == {401: None}
    # On the section from 98 m with the first axle to 128 m with the last, 10.5 m behind.
    begins, ends = {0: (110.0, 138.5), 1: (98.0, 138.5), 2: (100.0, 124.0), 3: (98.0, 138.5)}[task.way]
    at = [e.time_s for e in braked if e.kind is Kind.BRAKED or e.time_s > 10.0]
    assert at == [pytest.approx(begins / 5.0, abs=0.11), pytest.approx(ends / 5.0, abs=0.11)]


@pytest.mark.parametrize(("computed", "commanded"), [(9.5, 8.5), (0.1, 0.5), (float("inf"), 8.5), (3.0, 3.0)])
def test_an_exit_speed_that_cannot_be_is_strobed(computed: float, commanded: float) -> None:
    tasks = {(401, 1): TableBraking(computed)}
    control, track = humped(TABLE, [record(1, 2)], [rolling(1, 0.0)], (), Operation(tasks=tasks))
    assert [e.value for e in told(control, Kind.BRAKED)] == [commanded]
    strobed = [(e.element, e.cut, e.value) for e in told(control, Kind.STROBED)]
    assert strobed == [(401, 1, computed)] * (computed != commanded)
    assert track.braking == {401: None}


def test_two_cuts_on_a_retarder_are_braked_as_the_first_one_is() -> None:
    tasks = {(401, 1): UniformBraking(10.0), (401, 2): UniformBraking(20.0)}
    control, _ = humped(
        TABLE, [record(1, 2), record(2, 2)], [rolling(1, 0.0), rolling(2, 6.5)], (),
        Operation(rules=PUBLISHED_MODEL, tasks=tasks),
    )  # fmt: skip
    braked = [(e.cut, e.value) for e in told(control, Kind.BRAKED)]
    assert braked == [(1, 10.0), (2, 20.0)]
    second = next(e for e in told(control, Kind.BRAKED) if e.cut == 2)
    # Cut 2 is on it from 6.5 + 98/5 s on, but cut 1 rules until its last axle has left, at 138.5/5 s.
    assert second.time_s == pytest.approx(138.5 / 5.0, abs=0.1)
    assert second.time_s > 6.5 + 98.0 / 5.0 + 1.0


def test_a_cut_that_nobody_found_is_recorded_at_the_end() -> None:
    control, _ = humped(TABLE, [record(1, 2)], [moving_cut(1, axle_places(1).tolist(), 0.0, [(130.0, 5.0)])])
    assert [(e.element, e.cut, e.value) for e in told(control, Kind.MISROUTED)] == [(401, 1, Why.NOT_SEEN)]
    assert [(e.element, e.value) for e in told(control, Kind.COUNTERS_LEFT)] == [(401, 2.0)]


def test_a_track_that_no_route_leads_to_is_refused() -> None:
    for cut, words in ((record(1, 9), "track 9"), (record(1, 1, lead=1), "lead is 1; the hump has 1 lead, from 0 on")):
        with pytest.raises(PlantError, match=words):
            HumpControl(TABLE, SortingList((cut,)), ReferenceTrack(TABLE, []))
    with pytest.raises(PlantError, match="same number"):
        RouteStore(TABLE, [record(1, 1), record(1, 1)])


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
