"""Counters of axles: wrong uncoupling, slips and their repair, on the small hump (see test_hump_control) and alone."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from synth.hump.control.cut_routes import RouteTable
from synth.hump.control.events import Counters, Event, Kind, Why
from synth.hump.control.hump_control import HumpControl, Operation
from synth.hump.control.models import ENTRY, PUBLISHED_MODEL, PracticeRules
from synth.hump.control.section_counter import Finding, SectionCounter
from tests.plant_models.hump.random_humps import small_hump
from tests.synth.hump.control.made_trains import axle_places, humped, record
from tests.synth.hump.control.reference_sections import CounterSlip, LateSwitch, MovingCut, moving_cut

TABLE = RouteTable(small_hump())


def rolling(cut: int, start_s: float, cars: int = 1) -> MovingCut:
    """A cut at 5 m/s."""
    return moving_cut(cut, axle_places(cars).tolist(), start_s, [(500.0, 5.0)])


def told(control: HumpControl, *kinds: Kind) -> list[tuple[Kind, int, int, float]]:
    """Kind, element, cut and value of the events of some kinds."""
    return [(e.kind, e.element, e.cut, e.value) for e in control.events if e.kind in kinds]


@pytest.mark.requirement("HUMP-04")
def test_a_cut_that_stays_coupled_is_told_recorded_and_no_longer_awaited() -> None:
    """Cut 2, to track 2, stays on cut 1, to track 1: the switch must then be set for cut 3, to track 1, too."""
    cuts = [record(1, 1), record(2, 2), record(3, 1)]
    control, _ = humped(TABLE, cuts, [rolling(1, 0.0, cars=2), rolling(3, 15.0)])
    assert told(control, Kind.TOO_MANY_AXLES) == [(Kind.TOO_MANY_AXLES, 1, 1, 2.0)]
    assert told(control, Kind.MISROUTED)[0] == (Kind.MISROUTED, 1, 2, Why.COUPLED)
    assert control.state.arrived == {1: [1], 3: [1]}
    assert [e.value for e in commands(control)] == [0.0]


def commands(control: HumpControl) -> list[Event]:
    """Throws of switch 1."""
    return [e for e in control.events if e.kind is Kind.COMMANDED and e.element == 1]


def test_points_are_held_for_the_rest_of_a_cut_that_came_apart() -> None:
    """Cut 1 of two cars comes apart; its second car follows 25 m behind, cut 2 to the other side far behind."""
    cuts = [record(1, 2, cars=2), record(2, 1)]
    control, _ = humped(TABLE, cuts, [rolling(1, 0.0), rolling(1, 7.1), rolling(2, 40.0)])
    assert told(control, Kind.TOO_FEW_AXLES) == [(Kind.TOO_FEW_AXLES, 1, 1, 4.0)]
    assert control.state.arrived == {1: [2], 2: [1]}
    assert not control.state.misrouted
    assert not control.counters.left_over()


def test_axles_that_never_come_are_told_after_some_time() -> None:
    """Half of cut 1 stays behind: switch 1 is free from 12.5 s on, and patience is 30 m at 2 m/s."""
    control, _ = humped(TABLE, [record(1, 2, cars=2)], [rolling(1, 0.0)])
    first = next(e for e in control.events if e.kind is Kind.TOO_FEW_AXLES)
    assert (first.element, first.cut, first.value) == (1, 1, 4.0)
    assert first.time_s == pytest.approx(12.5 + 15.0, abs=0.2)
    assert set(control.counters.left_over()) == {e.element for e in control.state.alarms if e.element != 201}


@pytest.mark.parametrize(("start_s", "home"), [(15.0, True), (6.1, False)])
def test_the_rest_of_a_cut_may_go_another_way_and_no_counter_waits_for_it(start_s: float, home: bool) -> None:
    """The published model holds no points: they are thrown for cut 2, and the rest of cut 1 goes to track 1, too.

    `home`: the points are at home when the rest comes; otherwise, at 12.9 s, they are on their way, from 12.5 s on.
    """
    cuts = [record(1, 2, cars=2), record(2, 1)]
    objects = [rolling(1, 0.0), rolling(1, start_s)]
    control, track = humped(TABLE, cuts, objects, (), Operation(rules=PUBLISHED_MODEL))
    assert {cut: sorted(tracks) for cut, tracks in control.state.arrived.items()} == {1: [1, 2]}
    assert told(control, Kind.MISROUTED)[0] == (Kind.MISROUTED, 1, 1, Why.WRONG_POSITION)
    assert control.counters.left_over() == {}
    assert set(control.state.counters.values()) == {Counters()}
    assert told(control, Kind.COUNTER_FAULT) == []
    came = next(e.time_s for e in control.events if e.kind is Kind.MISROUTED)
    assert came == pytest.approx(start_s + 34.0 / 5.0 if home else 13.3, abs=0.11)
    assert not track.truth.moved_under


@pytest.mark.requirement("HUMP-08")
@pytest.mark.parametrize(
    ("end", "axle", "change", "value"),
    [(ENTRY, 3, 1, 1.0), (ENTRY, 1, -1, -1.0), (1, 2, -1, 1.0), (1, 2, 1, -1.0)],
)
def test_a_slip_is_told_put_right_and_misleads_no_later_cut(end: int, axle: int, change: int, value: float) -> None:
    """One axle of cut 1 too many or too few, at the entry joint of switch 1 or at its right exit joint."""
    cuts = [record(1, 2), record(2, 1)]
    control, _ = humped(TABLE, cuts, [rolling(1, 0.0), rolling(2, 40.0)], [CounterSlip(1, end, axle, change)])
    faults = told(control, Kind.COUNTER_FAULT)
    assert {(element, found) for _, element, _, found in faults} == {(1, value)}
    assert control.state.arrived == {1: [2], 2: [1]}
    assert control.counters.left_over() == {}
    assert set(control.state.counters.values()) == {Counters()}


def found(counter: SectionCounter, passes: list[tuple[float, bool]]) -> Iterator[Finding]:
    """Findings of gaps; each pass is a time and whether it is at the entry joint."""
    for time_s, enters in passes:
        for finding in counter.axle_in(time_s) if enters else counter.axle_out(time_s):
            if finding.kind not in (Kind.ENTRY_COUNTER, Kind.EXIT_COUNTER):
                yield finding


@pytest.mark.parametrize(
    ("gap_m", "speed_m_s", "after_m_s", "told_few"),
    [(11.0, 4.0, 4.0, False), (13.0, 4.0, 4.0, True), (11.0, 5.0, 3.0, False), (13.0, 3.0, 5.0, True)],
)
def test_a_gap_is_judged_by_the_speeds_of_both_axles(
    gap_m: float, speed_m_s: float, after_m_s: float, told_few: bool
) -> None:
    """Two axles of a cut over 8 m, the limit is 12 m; the speed changes evenly while the gap passes."""
    counter = SectionCounter(8.0, True, PracticeRules(), True)
    counter.expect(1, 2, 12.0)
    comes = gap_m / (0.5 * (speed_m_s + after_m_s))
    passes = [(0.0, True), (8.0 / speed_m_s, False), (comes, True), (comes + 8.0 / after_m_s, False)]
    findings = list(found(counter, passes))
    assert findings == ([Finding(Kind.TOO_FEW_AXLES, 1, 1)] if told_few else [])
    assert counter.is_clear


@pytest.mark.parametrize(
    ("gap_m", "after_m_s", "told_many"), [(5.5, 4.0, True), (6.5, 4.0, False), (13.0, 1.0, False), (4.5, 6.0, True)]
)
def test_the_gap_between_two_cuts_tells_whether_they_are_coupled(
    gap_m: float, after_m_s: float, told_many: bool
) -> None:
    """A bogie and one axle over 8 m; all come in at 4 m/s and are as fast as `after_m_s` from the middle on."""
    counter = SectionCounter(8.0, True, PracticeRules(), True)
    counter.expect(1, 2, 12.0)
    counter.expect(2, 1, 12.0)
    takes, comes = 1.0 + 4.0 / after_m_s, [0.0, 1.85 / 4.0, (1.85 + gap_m) / 4.0]
    passes = sorted([(time, True) for time in comes] + [(time + takes, False) for time in comes])
    findings = [finding for finding in found(counter, passes) if finding.kind is not Kind.CATCH_UP]
    assert findings == ([Finding(Kind.TOO_MANY_AXLES, 1, 2)] if told_many else [])


@pytest.mark.parametrize(("stands_s", "told_few"), [(0.0, True), (5.9, True), (6.1, False), (60.0, False)])
def test_an_axle_that_stood_on_the_section_tells_nothing_of_a_gap(stands_s: float, told_few: bool) -> None:
    """Two axles of a cut, 24 m apart over 8 m at 4 m/s, the second one with a stop; at 1 m/s it would take 8 s."""
    counter = SectionCounter(8.0, True, PracticeRules(), True)
    counter.expect(1, 2, 12.0)
    findings = list(found(counter, [(0.0, True), (2.0, False), (6.0, True), (8.0 + stands_s, False)]))
    assert findings == ([Finding(Kind.TOO_FEW_AXLES, 1, 1)] if told_few else [])


def test_a_part_of_a_cut_that_stays_behind_is_recorded_at_the_end() -> None:
    """Cut 1 comes apart; its first car goes home to track 2, its second one stands at 150 m, ahead of switch 2."""
    rest = moving_cut(1, axle_places(1).tolist(), 7.1, [(150.0, 5.0)])
    control, _ = humped(TABLE, [record(1, 2, cars=2)], [rolling(1, 0.0), rest])
    assert control.state.arrived == {1: [2]}
    assert told(control, Kind.MISROUTED) == [(Kind.MISROUTED, 2, 1, Why.NOT_SEEN)]
    assert sorted(control.counters.left_over()) == [2, 602]
    whole, _ = humped(TABLE, [record(1, 2, cars=2)], [rolling(1, 0.0), rolling(1, 7.1)])
    assert told(whole, Kind.MISROUTED) == []


@pytest.mark.parametrize("whole", [False, True])
def test_cars_of_a_cut_that_go_another_way_with_its_leader_are_recorded_at_the_end(whole: bool) -> None:
    """All belong to track 2, but the points come at 8.6 s, and cut 1 at 8 s. The first car of the last cut stays
    coupled to cut 1 or, if `whole`, to cut 2, which stays coupled to cut 1. The rest of the last cut goes home."""
    last = 3 if whole else 2
    cuts = [record(serial, 2, cars=2 if serial == last else 1) for serial in range(1, last + 1)]
    late = [LateSwitch(1, 7.8)]
    control, _ = humped(TABLE, cuts, [rolling(1, 0.0, cars=last), rolling(last, 20.0)], late)
    assert control.state.arrived == {1: [1], last: [2]}
    never_alone = [(Kind.MISROUTED, 201, 2, Why.NOT_SEEN)] if whole else []
    assert told(control, Kind.MISROUTED) == [
        (Kind.MISROUTED, 601, 1, Why.OFF_ROUTE),
        *never_alone,
        (Kind.MISROUTED, 1, last, Why.OFF_ROUTE),
    ]
    assert control.counters.left_over() == {}


def test_a_lone_axle_that_a_counter_took_for_another_cut_puts_no_cut_on_another_way() -> None:
    """The last axle of cut 1 is not counted at the right exit of switch 1. So the first one of cut 2 is counted for it
    at the left exit, and cut 2 lacks an axle at the end."""
    objects, slip = [rolling(1, 0.0), rolling(2, 8.0)], [CounterSlip(1, 1, 3, -1)]
    control, _ = humped(TABLE, [record(1, 2), record(2, 1)], objects, slip, Operation(rules=PUBLISHED_MODEL))
    of_cut_1 = [e.time_s for e in control.events if (e.kind, e.element, e.cut) == (Kind.EXIT_COUNTER, 1, 1)]
    assert max(of_cut_1) == pytest.approx(8.0 + 52.0 / 5.0)
    assert control.state.arrived == {1: [2], 2: [1]}
    assert told(control, Kind.MISROUTED) == [(Kind.MISROUTED, 1, 2, Why.NOT_SEEN)]


def test_an_axle_that_nobody_announced_is_a_fault() -> None:
    counter = SectionCounter(8.0, True, PracticeRules(), False)
    assert list(found(counter, [(0.0, True)])) == [Finding(Kind.COUNTER_FAULT, 0, 1.0)]
    assert list(found(counter, [(0.0, False)])) == [Finding(Kind.COUNTER_FAULT, 0, -1.0)]
    counter.expect(1, 2, 12.0)
    assert list(found(counter, [(0.0, False)])) == [Finding(Kind.COUNTER_FAULT, 1, -1.0)]


@pytest.mark.parametrize(("after_s", "dropped"), [(0.0, True), (0.92, True), (0.93, False), (2.0, False)])
def test_a_lone_axle_is_dropped_only_close_behind_the_cut_ahead_and_after_quiet(after_s: float, dropped: bool) -> None:
    """The section is told free from 0 s on, falsely. The one axle of cut 1 comes at 99 s, then one of cut 2.

    The axles of a bogie, 1.85 m apart, need 0.925 s at 2 m/s, and no longer."""
    counter = SectionCounter(8.0, True, PracticeRules(), False)
    counter.expect(1, 1, 12.0)
    counter.expect(2, 4, 12.0)
    list(counter.axle_in(99.0))
    list(counter.axle_in(99.0 + after_s))
    list(counter.axle_out(102.0))
    for now_s, clear in ((102.1, False), (116.9, False), (117.1, dropped)):
        list(counter.check(now_s, 0.0, lambda cut: False))
        assert counter.is_clear == clear


def test_an_axle_counted_twice_ahead_of_a_gap_is_no_division_by_zero() -> None:
    counter = SectionCounter(8.0, True, PracticeRules(), True)
    counter.expect(1, 2, 12.0)
    counter.expect(2, 1, 12.0)
    passes = [(0.0, True), (0.0, True), (1.0, True), (2.0, False), (2.0, False), (3.0, False)]
    assert [finding.kind for finding in found(counter, passes)] == [Kind.CATCH_UP]
