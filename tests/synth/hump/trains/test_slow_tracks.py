"""The slow simulator against trains that are worked out by hand: tracks, positions, pushing, and what is refused."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

import pytest

from tests.synth.hump.trains.by_hand import (
    BASE_M,
    FIRST_BEHIND_M,
    FREE,
    FROM_M,
    HALF_M,
    LENGTH_M,
    REDUCED_GRAVITY,
    run,
    stopping,
)
from tests.synth.hump.trains.made_slow_trains import (
    BRAKED_M,
    ENTRANCE_M,
    LEAD,
    LEFT_TRACK,
    POSITION,
    RIGHT_TRACK,
    SWITCH,
    bare_cut,
    one_switch,
)
from tests.synth.hump.trains.slow_humping import humped_slowly
from tests.synth.hump.trains.slow_train import Kind, Mark, SlowCut, SlowTrain


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
    assert found.of(Kind.TRACK_CONTACT)[0].value == pytest.approx(300.0 - (HALF_M + 2.0 * time_s), abs=1e-9)
    assert [event.cut for event in found.of(Kind.COUPLED)] == [0]
    assert found.heads_m == pytest.approx((300.0, 286.0), abs=1e-9)


def test_contact_on_the_track_with_a_cut_that_gets_slower() -> None:
    slow = stopping(bare_cut(LEFT_TRACK, 0.0, 2.0), 200.0)
    found = run(slow, bare_cut(LEFT_TRACK, 100.0, 4.0))
    assert found.outcome() == {("contact on the track", 601, 1), ("coupled", 601, 0)}
    # 7 + 4 (t − 100) is the head, −7 + 2 t − 0.005 t² the tail ahead of it
    time_s = 100.0 * (sqrt(4.0 + 7.72) - 2.0)
    assert found.of(Kind.TRACK_CONTACT)[0].time_s == pytest.approx(time_s, abs=1e-5)
    # both weigh the same: the mean of both speeds, then half the deceleration of the first
    speed, head = 0.5 * (4.0 + 2.0 - 0.01 * time_s), 7.0 + 2.0 * time_s - 0.005 * time_s**2
    assert found.of(Kind.COUPLED)[0].value == pytest.approx(sqrt(speed**2 - 0.01 * (300.0 - head)), abs=1e-3)
    assert found.heads_m == pytest.approx((300.0, 286.0), abs=1e-6)


@pytest.mark.parametrize(("free_to_m", "kind"), [(145.014, Kind.COUPLED), (145.018, Kind.TRACK_CONTACT)])
def test_it_is_a_coupling_once_the_cut_ahead_stands(free_to_m: float, kind: Kind) -> None:
    """The cut ahead would be reached when its head is at 145.016 m; all three happen in one step."""
    free = {**FREE, LEFT_TRACK: free_to_m}
    found = run(bare_cut(LEFT_TRACK, 0.0, 2.0), bare_cut(LEFT_TRACK, 38.004, 4.0), free_to_m=free)
    assert [event.kind for event in found.events if event.cut == 1] == [kind]
    assert found.heads_m == pytest.approx((free_to_m, free_to_m - LENGTH_M), abs=1e-9)
    if kind is Kind.COUPLED:
        assert found.closest_s == pytest.approx(5e-4, abs=1e-9)


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
