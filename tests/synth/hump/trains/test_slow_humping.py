"""The slow simulator against trains that are worked out by hand: joints, points, contacts, fouling, stops."""

from __future__ import annotations

from math import inf, sqrt

import pytest

from tests.synth.hump.trains.by_hand import (
    BASE_M,
    FIRST_BEHIND_M,
    FOULING_PLACE_M,
    FREE,
    FROM_M,
    HALF_M,
    LENGTH_M,
    REDUCED_GRAVITY,
    TO_M,
    TRACK_FROM_M,
    alarms,
    run,
    stopping,
)
from tests.synth.hump.trains.made_slow_trains import (
    LEAD,
    LEFT_TRACK,
    POINTS_M,
    POSITION,
    RIGHT_TRACK,
    SECTION,
    SWITCH,
    bare_cut,
    one_switch,
    straight,
    with_falling_left,
    with_section_ahead,
)
from tests.synth.hump.trains.slow_humping import humped_slowly
from tests.synth.hump.trains.slow_train import Kind, Mark, SlowTrain


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
    """From there on it is at joints with the last axle of the cut ahead, and its own last axle is its base behind."""
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


def test_contact_at_the_exit_joint() -> None:
    """What is behind that joint has passed; the last axle of the second cut, of two cars, is still to come."""
    found = run(bare_cut(LEFT_TRACK, 0.0, 2.0), bare_cut(LEFT_TRACK, 17.0, 4.0, cars=2))
    assert alarms(found) == {("not separated", SWITCH, 1), ("contact", SWITCH, 1)}
    assert found.of(Kind.CONTACT)[0].time_s == pytest.approx(17.0 + (TO_M - 12.5) / 4.0, abs=1e-9)
    assert found.time_s(1, SWITCH, Mark.FIRST_FROM) == pytest.approx(17.0 + (FROM_M - 12.5) / 4.0, abs=1e-9)
    assert found.time_s(1, SWITCH, Mark.LAST_FROM) == pytest.approx((FROM_M + 25.0 + FIRST_BEHIND_M) / 2.0, abs=1e-9)
    assert found.time_s(1, SWITCH, Mark.FIRST_TO) == pytest.approx(28.25, abs=1e-9)
    assert found.time_s(1, SWITCH, Mark.LAST_TO) == pytest.approx(28.25 + 25.0 / 2.0, abs=1e-9)


def test_a_cut_in_contact_goes_the_way_of_the_cut_ahead() -> None:
    """It touches at the section ahead of the switch, and is misrouted there behind the cut ahead."""
    cuts = (bare_cut(RIGHT_TRACK, 0.0, 2.0), bare_cut(LEFT_TRACK, 6.0, 4.0))
    found = humped_slowly(with_section_ahead(one_switch()), SlowTrain(cuts, LEAD, FREE))
    split = {("not separated", element, 1) for element in (SECTION, SWITCH, POSITION)}
    assert alarms(found) == {("contact", SECTION, 1), ("misrouted", SWITCH, 1), *split}
    assert found.tracks == (RIGHT_TRACK, RIGHT_TRACK)
    for element, place in ((SWITCH, FROM_M), (POSITION, 85.0), (602, 110.0)):
        ahead_s = (place + FIRST_BEHIND_M) / 2.0
        assert found.time_s(1, element, Mark.FIRST_FROM) == pytest.approx(ahead_s, abs=1e-9)
        assert found.time_s(1, element, Mark.LAST_FROM) == pytest.approx(ahead_s + BASE_M / 2.0, abs=1e-9)
    assert found.heads_m == pytest.approx((300.0, 286.0), abs=1e-9)


def test_a_misrouted_cut_still_leaves_what_is_behind_it() -> None:
    cuts = (bare_cut(LEFT_TRACK, 0.0, 4.0), bare_cut(RIGHT_TRACK, 7.5, 4.0, cars=2))
    found = humped_slowly(with_section_ahead(one_switch()), SlowTrain(cuts, LEAD, FREE))
    assert alarms(found) == {("not separated", SECTION, 1), ("misrouted", SWITCH, 1)}
    assert found.time_s(1, SECTION, Mark.LAST_TO) == pytest.approx(7.5 + 42.5 / 4.0, abs=1e-9)


def test_a_misrouted_cut_rolls_on_the_track_where_it_is() -> None:
    """The left branch falls; the second cut should go right, and rolls as the one ahead of it."""
    cuts = (bare_cut(LEFT_TRACK, 0.0, 4.0), bare_cut(RIGHT_TRACK, 6.0, 4.0))
    found = humped_slowly(with_falling_left(one_switch(), 8.0), SlowTrain(cuts, LEAD, FREE))
    assert alarms(found) == {("misrouted", SWITCH, 1)}
    for (_, element, mark), passage in [each for each in found.passages.items() if each[0][0] == 0]:
        assert found.time_s(1, element, mark) == pytest.approx(passage.time_s + 6.0, abs=1e-4)
    energy = 8.0 + REDUCED_GRAVITY * 8e-3 * 0.5 * (TRACK_FROM_M - POINTS_M + TRACK_FROM_M - BASE_M - POINTS_M)
    assert found.passages[0, 601, Mark.FIRST_FROM].speed_m_s == pytest.approx(sqrt(2.0 * energy), abs=1e-6)


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
