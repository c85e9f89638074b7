"""The slow simulator of humping against trains that are worked out by hand: cars without resistance on flat track.

The first axle of such a car is 5.5 m behind the crest when it is let go, the last one 5.5 m ahead of it.
"""

from __future__ import annotations

from dataclasses import replace
from math import inf, sqrt

import pytest

from tests.synth.yard.humping.made_slow_trains import (
    BRAKED_M,
    ENTRANCE_M,
    LEAD,
    LEFT_TRACK,
    POSITION,
    RIGHT_TRACK,
    SWITCH,
    bare_cut,
    one_switch,
    straight,
)
from tests.synth.yard.humping.slow_humping import humped_slowly
from tests.synth.yard.humping.slow_train import Kind, Mark, SlowCut, SlowRun, SlowTrain

FREE = {LEFT_TRACK: 300.0, RIGHT_TRACK: 300.0}
REDUCED_GRAVITY = 9.81 / (1.0 + 0.42 * 2 / 80.0)
FIRST_BEHIND_M, BASE_M, HALF_M, LENGTH_M = 5.5, 11.0, 7.0, 14.0
FROM_M, TO_M, FOULING_PLACE_M, TRACK_FROM_M = 40.0, 51.0, 72.0, 86.0


def run(*cuts: SlowCut, free_to_m: dict[int, float] | None = None) -> SlowRun:
    return humped_slowly(one_switch(), SlowTrain(cuts, LEAD, free_to_m or FREE))


def alarms(found: SlowRun) -> set[tuple[str, int, int]]:
    """What happened but couplings and gaps."""
    return {each for each in found.outcome() if each[0] not in (Kind.COUPLED.value, Kind.GAP.value)}


def stopping(cut: SlowCut, path_m: float) -> SlowCut:
    """The cut with the resistance that stops it `path_m` behind the place where it is let go."""
    w0 = 1e3 * 0.5 * cut.hump_speed_m_s**2 / (REDUCED_GRAVITY * path_m)
    return replace(cut, body=replace(cut.body, w0_n_per_kn=w0))


def test_two_like_cuts_keep_their_interval_and_come_to_joints_as_worked_out() -> None:
    graph = straight(40.0)
    cuts = [bare_cut(LEFT_TRACK, t, 2.0) for t in (0.0, LENGTH_M / 2.0)]
    found = humped_slowly(graph, SlowTrain(tuple(cuts), LEAD, {LEFT_TRACK: 400.0}))
    marks = {(element, mark) for cut, element, mark in found.passages if cut == 0}
    assert len(marks) == 7
    for element, mark in marks:
        interval = found.time_s(1, element, mark) - found.time_s(0, element, mark)
        assert interval == pytest.approx(LENGTH_M / 2.0, abs=1e-5)
    # half of the weight stands on the slope until the last axle comes to the crest
    g = REDUCED_GRAVITY * 0.04
    both_on_slope = sqrt(2.0**2 + g * FIRST_BEHIND_M)
    seconds = 2.0 * FIRST_BEHIND_M / (2.0 + both_on_slope)
    for place, mark, element in (
        (20.0, Mark.FIRST_FROM, 602),
        (50.0, Mark.FIRST_TO, 602),
        (80.0, Mark.FIRST_FROM, 601),
    ):
        passage = found.passages[0, element, mark]
        speed = sqrt(both_on_slope**2 + 2.0 * g * (place - 2.0 * FIRST_BEHIND_M))
        assert passage.speed_m_s == pytest.approx(speed, abs=1e-6)
        assert passage.time_s == pytest.approx(seconds + (speed - both_on_slope) / g, abs=1e-5)


def test_a_cut_comes_to_every_mark_of_the_switch_when_it_must() -> None:
    found = run(bare_cut(LEFT_TRACK, 3.0, 4.0))
    places = {Mark.FIRST_FROM: FROM_M, Mark.FIRST_TO: TO_M, Mark.FIRST_FOULING: FOULING_PLACE_M}
    last = {Mark.LAST_FROM: FROM_M, Mark.LAST_TO: TO_M, Mark.LAST_FOULING: FOULING_PLACE_M}
    for mark, place in places.items():
        assert found.time_s(0, SWITCH, mark) == pytest.approx(3.0 + (place - FIRST_BEHIND_M) / 4.0, abs=1e-9)
    for mark, place in last.items():
        assert found.time_s(0, SWITCH, mark) == pytest.approx(3.0 + (place + FIRST_BEHIND_M) / 4.0, abs=1e-9)
    assert found.time_s(0, 601, Mark.TRACK) == pytest.approx(3.0 + (TRACK_FROM_M - HALF_M) / 4.0, abs=1e-9)
    (coupling,) = found.events
    assert (coupling.kind, coupling.element) == (Kind.COUPLED, 601)
    assert coupling.time_s == pytest.approx(3.0 + 293.0 / 4.0, abs=1e-9)
    assert coupling.value == pytest.approx(4.0, abs=1e-9)


@pytest.mark.parametrize(
    ("interval_s", "ahead", "behind", "happened"),
    [
        # the last axle leaves the section 5.5 s after the first one came; the points need 0.8 s more
        (6.301, LEFT_TRACK, RIGHT_TRACK, set()),
        (6.299, LEFT_TRACK, RIGHT_TRACK, {("misrouted", SWITCH, 1)}),
        (5.501, LEFT_TRACK, RIGHT_TRACK, {("misrouted", SWITCH, 1)}),
        (5.499, LEFT_TRACK, RIGHT_TRACK, {("misrouted", SWITCH, 1), ("not separated", SWITCH, 1)}),
        (5.499, LEFT_TRACK, LEFT_TRACK, {("not separated", SWITCH, 1)}),
        (5.501, LEFT_TRACK, LEFT_TRACK, set()),
    ],
)
def test_the_points_are_thrown_in_time_or_not(
    interval_s: float, ahead: int, behind: int, happened: set[tuple[str, int, int]]
) -> None:
    found = run(
        bare_cut(ahead, 0.0, 4.0), bare_cut(behind, interval_s, 4.0, (4.0,)), bare_cut(behind, 60.0, 4.0, (4.0,))
    )
    assert alarms(found) == happened
    goes = ahead if ("misrouted", SWITCH, 1) in happened else behind
    assert found.tracks == (ahead, goes, behind)
    nearest = min(abs(interval_s - 6.3), abs(interval_s - 5.5)) if ahead != behind else abs(interval_s - 5.5)
    assert found.closest_s == pytest.approx(nearest, abs=1e-9)
    behind_it = [LENGTH_M * sum(found.tracks[j] == found.tracks[i] for j in range(i)) for i in range(3)]
    assert found.heads_m == pytest.approx([300.0 - back for back in behind_it], abs=1e-9)


def test_points_lie_as_the_last_cut_left_them_though_it_was_misrouted() -> None:
    """The second cut goes left instead of right; the third finds its points left, the fourth must wait for them."""
    times = (0.0, 6.0, 12.0, 18.0)
    tracks = (LEFT_TRACK, RIGHT_TRACK, LEFT_TRACK, RIGHT_TRACK)
    found = run(*(bare_cut(track, time, 4.0, (4.0,)) for track, time in zip(tracks, times, strict=True)))
    assert alarms(found) == {("misrouted", SWITCH, 1), ("misrouted", SWITCH, 3)}
    assert set(found.tracks) == {LEFT_TRACK}


@pytest.mark.parametrize(("interval_s", "is_fouled"), [(20.43, True), (22.12, True), (22.13, False)])
def test_a_slow_cut_behind_the_switch_fouls_the_other_branch(interval_s: float, is_fouled: bool) -> None:
    found = run(bare_cut(LEFT_TRACK, 0.0, 2.0), bare_cut(RIGHT_TRACK, interval_s, 4.0, (4.0,)))
    assert alarms(found) == ({("fouled", SWITCH, 1)} if is_fouled else set())
    assert found.tracks == (LEFT_TRACK, RIGHT_TRACK)


def test_contact_at_the_entry_joint() -> None:
    """From there on it is at joints with the last axle of the cut ahead, and its own last axle by that one's speed."""
    found = run(bare_cut(LEFT_TRACK, 0.0, 2.0), bare_cut(LEFT_TRACK, 14.0, 4.0))
    assert alarms(found) == {("not separated", SWITCH, 1), ("contact", SWITCH, 1)}
    assert found.of(Kind.CONTACT)[0].time_s == pytest.approx(14.0 + 34.5 / 4.0, abs=1e-9)
    pairs = ((Mark.FIRST_FROM, Mark.LAST_FROM), (Mark.FIRST_TO, Mark.LAST_TO), (Mark.FIRST_FOULING, Mark.LAST_FOULING))
    for (first, last), place in zip(pairs, (FROM_M, TO_M, FOULING_PLACE_M), strict=True):
        ahead_s = (place + FIRST_BEHIND_M) / 2.0
        assert found.time_s(1, SWITCH, first) == pytest.approx(ahead_s, abs=1e-9)
        assert found.time_s(1, SWITCH, last) == pytest.approx(ahead_s + BASE_M / 2.0, abs=1e-9)
    assert found.in_contact == (False, True)
    assert [event.cut for event in found.of(Kind.COUPLED)] == [0]
    assert found.heads_m == pytest.approx((300.0, 286.0), abs=1e-9)


def test_contact_at_the_exit_joint_leaves_the_times_at_the_entry_joint() -> None:
    found = run(bare_cut(LEFT_TRACK, 0.0, 2.0), bare_cut(LEFT_TRACK, 15.0, 4.0))
    assert alarms(found) == {("not separated", SWITCH, 1), ("contact", SWITCH, 1)}
    assert found.of(Kind.CONTACT)[0].time_s == pytest.approx(15.0 + 45.5 / 4.0, abs=1e-9)
    assert found.time_s(1, SWITCH, Mark.FIRST_FROM) == pytest.approx(15.0 + 34.5 / 4.0, abs=1e-9)
    assert found.time_s(1, SWITCH, Mark.LAST_FROM) == pytest.approx(15.0 + 45.5 / 4.0, abs=1e-9)
    assert found.time_s(1, SWITCH, Mark.FIRST_TO) == pytest.approx(28.25, abs=1e-9)
    assert found.time_s(1, SWITCH, Mark.LAST_TO) == pytest.approx(28.25 + 5.5, abs=1e-9)


def test_a_third_cut_rolls_behind_one_that_rolls_behind_another() -> None:
    found = run(*(bare_cut(LEFT_TRACK, t, v) for t, v in ((0.0, 2.0), (14.0, 4.0), (19.0, 4.0))))
    assert {event.cut for event in found.of(Kind.CONTACT)} == {1, 2}
    assert found.time_s(2, SWITCH, Mark.FIRST_FROM) == pytest.approx(28.25, abs=1e-9)
    assert found.time_s(2, SWITCH, Mark.LAST_TO) == pytest.approx(
        (TO_M + FIRST_BEHIND_M) / 2.0 + 2 * BASE_M / 2.0, abs=1e-9
    )
    assert found.heads_m == pytest.approx((300.0, 286.0, 272.0), abs=1e-9)


@pytest.mark.parametrize(
    ("path_m", "happened"),
    [
        (30.0, {("contact", SWITCH, 1), ("not separated", SWITCH, 1), ("misrouted", SWITCH, 1)}),
        (40.0, {("contact", SWITCH, 1), ("not separated", SWITCH, 1), ("misrouted", SWITCH, 1)}),
        (47.0, {("contact", SWITCH, 1), ("not separated", SWITCH, 1), ("misrouted", SWITCH, 1)}),
        (62.0, {("fouled", SWITCH, 1)}),
    ],
)
def test_a_cut_that_stops_blocks_what_it_stands_on(path_m: float, happened: set[tuple[str, int, int]]) -> None:
    """Ahead of the switch, with its first axle on it, across it, and behind it short of the fouling point."""
    slow = stopping(bare_cut(LEFT_TRACK, 0.0, 2.0), path_m)
    found = run(slow, bare_cut(RIGHT_TRACK, 100.0, 4.0, (4.0,)))
    element = LEAD if path_m < 34.5 else SWITCH
    assert alarms(found) == {("stopped", element, 0), *happened}
    assert found.of(Kind.STOPPED)[0].time_s == pytest.approx(path_m, abs=1e-6)
    stood = HALF_M + path_m
    assert found.heads_m == pytest.approx((stood, 300.0 if path_m == 62.0 else stood - LENGTH_M), abs=1e-6)
    if path_m == 47.0:
        assert found.time_s(1, SWITCH, Mark.FIRST_FROM) == pytest.approx(100.0 + 34.5 / 4.0, abs=1e-9)
        assert found.time_s(1, SWITCH, Mark.FIRST_TO) == inf


def test_a_cut_leaves_a_gap_and_the_next_one_couples_with_it() -> None:
    slow = stopping(bare_cut(LEFT_TRACK, 0.0, 2.0), 200.0)
    found = run(slow, bare_cut(LEFT_TRACK, 300.0, 4.0), stopping(bare_cut(LEFT_TRACK, 400.0, 2.0), 100.0))
    assert found.outcome() == {("gap", 601, 0), ("coupled", 601, 1), ("gap", 601, 2)}
    assert [event.value for event in found.of(Kind.GAP)] == pytest.approx([93.0, 179.0 - 107.0], abs=1e-6)
    assert found.of(Kind.COUPLED)[0].value == pytest.approx(4.0, abs=1e-9)
    assert found.heads_m == pytest.approx((207.0, 193.0, 107.0), abs=1e-6)


@pytest.mark.parametrize(("interval_s", "time_s"), [(38.0, 69.0), (17.0, 36.75)])
def test_contact_on_the_track_while_the_cut_ahead_rolls(interval_s: float, time_s: float) -> None:
    """On the way, and where the head comes to the track and the cut ahead still reaches back there."""
    found = run(bare_cut(LEFT_TRACK, 0.0, 2.0), bare_cut(LEFT_TRACK, interval_s, 4.0))
    assert [event.time_s for event in found.of(Kind.TRACK_CONTACT)] == pytest.approx([time_s], abs=1e-9)
    assert [event.cut for event in found.of(Kind.COUPLED)] == [0]
    assert found.heads_m == pytest.approx((300.0, 286.0), abs=1e-9)


@pytest.mark.parametrize(("free_to_m", "kind"), [(143.99, Kind.COUPLED), (145.01, Kind.TRACK_CONTACT)])
def test_it_is_a_coupling_once_the_cut_ahead_stands(free_to_m: float, kind: Kind) -> None:
    """The cut ahead would be reached at 69 s, when its head is at 145 m."""
    free = {**FREE, LEFT_TRACK: free_to_m}
    found = run(bare_cut(LEFT_TRACK, 0.0, 2.0), bare_cut(LEFT_TRACK, 38.0, 4.0), free_to_m=free)
    assert [event.kind for event in found.events if event.cut == 1] == [kind]
    assert found.heads_m == pytest.approx((free_to_m, free_to_m - LENGTH_M), abs=1e-9)


@pytest.mark.parametrize(
    ("command_m_s", "heads_m", "exit_m_s"),
    [(2.0, (), 2.0), (6.0, (), 4.0), (2.0, (1.0,), 2.0), (2.0, (0.3,), sqrt(16.0 - 0.6 * REDUCED_GRAVITY))],
)
def test_a_position_brakes_evenly(command_m_s: float, heads_m: tuple[float, ...], exit_m_s: float) -> None:
    """To the command, at most to the unbraked exit speed, at least to what full brake leaves."""
    found = run(replace(bare_cut(RIGHT_TRACK, 0.0, 4.0, (command_m_s,)), brake_heads_m=heads_m))
    begin, end = (found.passages[0, POSITION, mark] for mark in (Mark.ENTRANCE, Mark.EXIT))
    assert begin.time_s == pytest.approx((ENTRANCE_M - FIRST_BEHIND_M) / 4.0, abs=1e-9)
    path = BRAKED_M + BASE_M
    assert end.speed_m_s == pytest.approx(exit_m_s, abs=1e-9)
    assert end.time_s - begin.time_s == pytest.approx(2.0 * path / (4.0 + exit_m_s), abs=1e-9)
    within = found.passages[0, POSITION, Mark.FIRST_TO]
    speed = sqrt(16.0 + (exit_m_s**2 - 16.0) * 22.0 / path)
    assert within.speed_m_s == pytest.approx(speed, abs=1e-9)
    assert within.time_s - begin.time_s == pytest.approx(2.0 * 22.0 / (4.0 + speed), abs=1e-9)


@pytest.mark.parametrize(("interval_s", "exit_m_s", "third_m_s"), [(8.0, 2.0, 2.0), (12.0, 3.0, 3.5)])
def test_cuts_that_are_not_separated_get_the_command_of_the_first(
    interval_s: float, exit_m_s: float, third_m_s: float
) -> None:
    cuts = [bare_cut(RIGHT_TRACK, k * interval_s, 4.0, (command,)) for k, command in enumerate((2.0, 3.0, 3.5))]
    found = run(*cuts)
    exits = [found.passages[i, POSITION, Mark.EXIT].speed_m_s for i in range(3)]
    assert exits == pytest.approx([2.0, exit_m_s, third_m_s], abs=1e-9)
    assert [event.cut for event in found.of(Kind.NOT_SEPARATED)] == ([1, 2] if exit_m_s == 2.0 else [])


def test_a_long_cut_comes_to_the_first_joint_while_it_is_pushed() -> None:
    """Seven cars: the first axle is at the joint before the middle is at the crest, while the train gets faster."""
    cuts = (bare_cut(LEFT_TRACK, 0.0, 2.0), bare_cut(LEFT_TRACK, 40.0, 2.8, cars=7))
    found = run(*cuts)
    to_go = 0.5 * 7 * LENGTH_M - 1.5 - FROM_M
    grows = 0.8 / 40.0
    seconds = (2.8 - sqrt(2.8**2 - 2.0 * grows * to_go)) / grows
    assert found.time_s(1, SWITCH, Mark.FIRST_FROM) == pytest.approx(40.0 - seconds, abs=1e-9)


@pytest.mark.parametrize(
    ("cut", "free_to_m", "sentence"),
    [
        (bare_cut(LEFT_TRACK, 0.0, 2.0, ()), FREE, "fewer commands"),
        (bare_cut(RIGHT_TRACK, 0.0, 2.0, (0.0,)), FREE, "more than 0"),
        (bare_cut(RIGHT_TRACK, 0.0, 2.0, (2.0,), cars=13), FREE, "longer than the way"),
        (bare_cut(RIGHT_TRACK, 0.0, 2.0, (2.0,)), {LEFT_TRACK: 50.0, RIGHT_TRACK: 300.0}, "on the last section"),
    ],
)
def test_what_the_model_does_not_speak_of_is_refused(cut: SlowCut, free_to_m: dict[int, float], sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        humped_slowly(one_switch(), SlowTrain((cut,), LEAD, free_to_m))
