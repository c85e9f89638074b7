"""A traced train is the train that was humped: the same instants, the same meetings, the same ends."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from synth.aim.coupling_speed import COUPLING_SPEED_M_S
from synth.hump.trains.hump_routes import OF_FIRST_AXLE, Mark
from synth.hump.trains.outcomes import outcomes
from synth.hump.trains.train_trace import AlarmKind, TracedCut, TrainTrace, body_of, train_trace
from tests.synth.hump.trains.humped_trains import CUTS, FIRST, TRAINS, HumpedTrains, humped_trains

STEP_S = 0.02
"""The trace rolls in steps of a metre, the humping in steps of six: so far instants may differ."""


@pytest.fixture(scope="module")
def humped() -> HumpedTrains:
    return humped_trains()


@pytest.fixture(scope="module")
def traces(humped: HumpedTrains) -> list[TrainTrace]:
    return [train_trace(humped.hump, humped.trains, humped.memory, lane) for lane in range(TRAINS)]


def marks_m(humped: HumpedTrains, lane: int, cut: TracedCut) -> np.ndarray:
    """Where the head is at each mark, (elements, marks), from the lengths alone."""
    row = lane * CUTS + cut.cut
    axle = np.where(OF_FIRST_AXLE, humped.trains.first_axle_m[row], humped.trains.last_axle_m[row])
    return np.asarray(humped.hump.routes.place_m[cut.route] + axle)


def met_s(humped: HumpedTrains, trace: TrainTrace) -> dict[int, float]:
    """When cuts first touched others, or were touched on their track."""
    lane = trace.number - FIRST
    found: dict[int, float] = {}
    for alarm in trace.alarms:
        if alarm.kind in (AlarmKind.CONTACT, AlarmKind.ON_TRACK):
            cuts = body_of(humped.memory, lane, alarm.cut).tolist()
            found.update({cut: min(alarm.time_s, found.get(cut, np.inf)) for cut in cuts})
    return found


def test_the_trains_have_all_that_is_to_be_shown(traces: list[TrainTrace]) -> None:
    kinds = {alarm.kind for trace in traces for alarm in trace.alarms}
    assert kinds >= {AlarmKind.MISROUTED, AlarmKind.CONTACT, AlarmKind.UNSEPARATED, AlarmKind.ON_TRACK}
    assert [trace.number for trace in traces] == list(range(FIRST, FIRST + TRAINS))


def test_times_at_marks_are_those_of_the_memory(humped: HumpedTrains, traces: list[TrainTrace]) -> None:
    """For cuts in contact, up to the element where they touch: from there on the model shifts those of the leader."""
    compared = 0
    for lane, trace in enumerate(traces):
        touched = met_s(humped, trace)
        for cut in trace.cuts:
            told = humped.memory.time_s[lane, cut.cut]
            marks = marks_m(humped, lane, cut)
            traced = np.interp(marks, cut.trace.head_m, cut.trace.time_s, left=np.nan, right=np.nan)
            before = told < touched.get(cut.cut, np.inf) - STEP_S
            before[humped.memory.contact_at[lane, cut.cut] :] = False
            before &= ~(marks > humped.memory.touch_m[lane, cut.cut] - 1e-6)  # it may wait for the tail there
            np.testing.assert_allclose(traced[before], told[before], atol=STEP_S)
            compared += int(before.sum())
            if cut.cut not in touched:
                np.testing.assert_array_equal(np.isfinite(traced), np.isfinite(told))
    assert compared > 0.9 * np.isfinite(humped.memory.time_s).sum() - CUTS


def test_a_trace_goes_forwards_at_its_own_speed(humped: HumpedTrains, traces: list[TrainTrace]) -> None:
    """Metres in each step are the mean of both speeds times its duration, the last bit before a stop
    included; cuts that touch others left out."""
    for trace in traces:
        touched = met_s(humped, trace)
        for cut in trace.cuts:
            way = cut.trace
            steps = np.diff(way.time_s)
            assert (steps > 0.0).all()
            assert (np.diff(way.head_m) >= 0.0).all()
            if cut.cut not in touched:
                rolled = 0.5 * (way.speed_m_s[1:] + way.speed_m_s[:-1]) * steps
                assert np.abs(rolled - np.diff(way.head_m)).max() < 0.05


def test_ends_are_those_of_the_memory(humped: HumpedTrains, traces: list[TrainTrace]) -> None:
    for lane, trace in enumerate(traces):
        for cut in trace.cuts:
            end = humped.memory.end_m[lane, cut.cut]
            if not np.isfinite(end):
                continue
            by_itself = cut.cut not in met_s(humped, trace)
            assert cut.trace.head_m[-1] == pytest.approx(end, abs=1e-6 if by_itself else 5e-3)
            if humped.memory.caught_on_track[lane, cut.cut]:
                continue
            speed = humped.memory.end_speed_m_s[lane, cut.cut]
            assert cut.trace.speed_m_s[-1] == pytest.approx(speed, abs=0.01)


def test_passes_are_those_of_the_memory(humped: HumpedTrains, traces: list[TrainTrace]) -> None:
    memory, routes = humped.memory, humped.hump.routes
    for lane, trace in enumerate(traces):
        touched = {a.cut: a.time_s for a in trace.alarms if a.kind in (AlarmKind.CONTACT, AlarmKind.ON_TRACK)}
        for cut in trace.cuts:
            for position, each in enumerate(cut.passages):
                assert each.command_m_s == memory.command_m_s[lane, cut.cut, position]
                assert each.number in {element.number for element in routes.routes[cut.route].elements}
                if np.isfinite(each.end_s) and each.end_s < touched.get(cut.cut, np.inf):
                    leaves = routes.exit_m[cut.route, position] + humped.trains.last_axle_m[lane * CUTS + cut.cut]
                    assert cut.trace.head_at(np.array(each.end_s)) == pytest.approx(leaves, abs=1e-6)


def test_a_cut_in_contact_stays_behind_the_tail_of_its_leader(traces: list[TrainTrace]) -> None:
    found = 0
    for trace in traces:
        for alarm in trace.alarms:
            if alarm.kind not in (AlarmKind.CONTACT, AlarmKind.ON_TRACK) or alarm.ahead is None:
                continue
            cut, leader = trace.cuts[alarm.cut], trace.cuts[alarm.ahead]
            assert cut.route == leader.route
            times = np.linspace(alarm.time_s, trace.end_s, 200)
            room = leader.trace.head_at(times) - leader.length_m - cut.trace.head_at(times)
            assert room.min() > -0.3
            if alarm.kind is AlarmKind.CONTACT:
                assert room[-1] == pytest.approx(0.0, abs=1.0)
            found += 1
    assert found > 20


def test_elements_that_two_cuts_occupy_are_those_that_the_memory_tells(
    humped: HumpedTrains, traces: list[TrainTrace]
) -> None:
    """The intervals of each element, one cut after the other, against what was judged while the train was humped."""
    routes = humped.hump.routes
    for lane, trace in enumerate(traces):
        both: set[tuple[int, int]] = set()
        for number in routes.numbers:
            users = sorted((o for o in trace.occupied if o.number == number), key=lambda o: o.cut)
            both |= {(behind.cut, number) for ahead, behind in pairwise(users) if behind.from_s < ahead.to_s}
        told = {
            (int(cut), routes.numbers[routes.vertex[trace.cuts[cut].route, column]])
            for cut, column in zip(*np.nonzero(humped.memory.unseparated[lane]), strict=True)
        }
        assert both == told


def test_alarms_and_ends_add_up_to_the_outcomes(humped: HumpedTrains, traces: list[TrainTrace]) -> None:
    found = outcomes(humped.hump.routes, humped.trains, humped.memory)
    for lane, trace in enumerate(traces):
        count = {kind: sum(alarm.kind is kind for alarm in trace.alarms) for kind in AlarmKind}
        assert count[AlarmKind.MISROUTED] == found.misrouted[lane].sum()
        assert count[AlarmKind.CONTACT] == found.contact[lane].sum()
        assert count[AlarmKind.OVERSPEED] == found.overspeed[lane].sum()
        assert sum(cut.gap_m or 0.0 for cut in trace.cuts) == pytest.approx(found.gap_m[lane])
        judged = [cut for cut in trace.cuts if cut.coupled_m_s is not None or cut.gap_m is not None]
        assert len(judged) == found.judged[lane]
        fast = [cut for cut in judged if (cut.coupled_m_s or 0.0) > COUPLING_SPEED_M_S]
        assert len(fast) == count[AlarmKind.OVERSPEED]
        assert trace.mean_hump_speed_m_s == pytest.approx(found.span_m[lane] / found.span_s[lane])


def test_alarms_come_in_order_and_when_they_are_told(humped: HumpedTrains, traces: list[TrainTrace]) -> None:
    for lane, trace in enumerate(traces):
        assert [a.time_s for a in trace.alarms] == sorted(a.time_s for a in trace.alarms)
        for alarm in trace.alarms:
            if alarm.kind is AlarmKind.MISROUTED:
                column = humped.memory.misrouted_at[lane, alarm.cut]
                assert alarm.time_s == humped.memory.time_s[lane, alarm.cut, column, Mark.FIRST_IN]
                assert trace.cuts[alarm.cut].route != trace.cuts[alarm.cut].wanted
