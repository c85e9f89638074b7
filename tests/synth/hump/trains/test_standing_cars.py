"""Cuts on their tracks: those that catch another while it rolls, and what is seen to be free."""

from __future__ import annotations

import numpy as np
import pytest

from synth.hump.trains.coupling_on_track import OnTrack, contact_on_track
from synth.hump.trains.motion import Cars, Moving
from synth.hump.trains.standing_cars import StandingCars
from tests.synth.hump.trains.bare_cuts import GRAVITY_M_S2, EvenFall

LENGTH_M = 14.0

NEVER, NO_MARKS = np.array([np.inf]), np.empty((1, 0))


class BareCars(Cars):
    """Cars that weigh the same and may couple."""

    rolls: EvenFall


def cars(resisted: float = 0.0, row: int = 0) -> BareCars:
    """One cut on flat track, which resistance slows down."""
    return BareCars(EvenFall(0.0, np.full(row + 1, resisted)), np.array([row]), np.array([0]))


def moving(head_m: float, speed_m_s: float, time_s: float) -> Moving:
    """One cut."""
    return Moving(np.array([head_m]), np.array([speed_m_s]), np.array([time_s]))


def closing(ahead: Moving, behind: Moving, ends_m: tuple[float, float], resisted: tuple[float, float]) -> float:
    """Of two cuts, the first one 14 m long."""
    one = OnTrack(cars(resisted[0]), ahead, np.array([ends_m[0]]), NEVER)
    other = OnTrack(cars(resisted[1]), behind, np.array([ends_m[1]]), NEVER)
    return float(contact_on_track(one, other, np.array([LENGTH_M])).closing_m_s[0])


def test_a_faster_cut_couples_at_the_difference() -> None:
    """1 and 1.5 m/s, 18 s apart: the gap of 14 + 18·… closes 28 s after the first one, within the 300 m of its way."""
    assert closing(moving(118.0, 1.0, 0.0), moving(118.0, 1.5, 18.0), (440.0, 426.0), (0.0, 0.0)) == pytest.approx(0.5)


def test_a_slower_cut_does_not_catch_another() -> None:
    assert np.isnan(closing(moving(118.0, 1.5, 0.0), moving(118.0, 1.4, 18.0), (440.0, 426.0), (0.0, 0.0)))


def test_one_that_slows_down_is_caught_at_the_difference_of_both_speeds() -> None:
    """The first one loses 0.2 m/s² from 2 m/s, with its tail at 104 m, and would stop 10 m farther; the second comes
    from 103 m at 1.5 m/s. The touch is told at the first of 48 places behind it, 0.23 m apart here."""
    resisted = 0.2 / GRAVITY_M_S2
    found = closing(moving(118.0, 2.0, 0.0), moving(103.0, 1.5, 0.0), (128.0, 114.0), (resisted, 0.0))
    meets_s = (0.5 + np.sqrt(0.25 + 4.0 * 0.1 * 1.0)) / 0.2
    speed = 2.0 - 0.2 * meets_s
    later = np.sqrt(speed**2 - 2.0 * 0.2 * 0.24)
    assert 1.5 - speed <= found <= 1.5 - later
    assert later < speed - 0.05


def test_one_that_stands_before_the_other_comes_is_not_caught_rolling() -> None:
    standing = StandingCars(np.array([[130.0]]), cars(row=1).rolls)
    first = standing.add(
        np.array([0]), cars(), moving(118.0, 1.0, 0.0), moving(130.0, 1.0, 12.0), np.array([LENGTH_M]), NO_MARKS
    )
    assert len(first.which) == 0
    later = moving(108.0, 1.5, 8.0), moving(116.0, 1.5, 8.0 + 8.0 / 1.5)
    assert len(standing.add(np.array([0]), cars(row=1), *later, np.array([LENGTH_M]), NO_MARKS).which) == 0
    assert standing.free_m.tolist() == [[130.0 - 2.0 * LENGTH_M]]


def test_what_is_free_is_seen_as_it_was_at_the_time() -> None:
    """A cut that rolls is taken to couple, also by one behind another that still rolls; when it stands, one sees its
    gap."""
    standing, lanes, routes = StandingCars(np.array([[400.0]]), cars(row=1).rolls), np.array([0]), np.array([0])
    resisted = 0.1 / GRAVITY_M_S2

    def seen(now_s: float) -> float:
        return float(standing.seen_m(lanes, routes, np.array([now_s]))[0])

    assert seen(0.0) == 400.0
    length = np.array([LENGTH_M])
    standing.add(lanes, cars(resisted), moving(100.0, 2.0, 10.0), moving(120.0, 0.0, 30.0), length, NO_MARKS)
    assert seen(29.0) == 400.0 - LENGTH_M
    assert seen(30.0) == 120.0 - LENGTH_M
    standing.add(lanes, cars(resisted, 1), moving(80.0, 1.0, 25.0), moving(85.0, 0.0, 35.0), length, NO_MARKS)
    assert seen(29.0) == 400.0 - 2.0 * LENGTH_M
    assert seen(35.0) == 85.0 - LENGTH_M


def test_cuts_that_do_not_come_by_themselves_take_room() -> None:
    standing = StandingCars(np.array([[400.0, 300.0]]), cars().rolls)
    standing.block(np.array([0]), np.array([1]), np.array([LENGTH_M]))
    assert standing.free_m.tolist() == [[400.0, 300.0 - LENGTH_M]]


def braked_m_s2(slowed: tuple[float, ...]) -> EvenFall:
    """Cuts on flat track that lose so much speed in a second."""
    return EvenFall(0.0, np.array(slowed) / GRAVITY_M_S2)


@pytest.mark.parametrize(("second_m_s2", "free_m"), [(0.01, 400.0), (0.05, 400.0), (0.01, 180.0)])
def test_two_cuts_that_touch_roll_on_with_their_momentum(second_m_s2: float, free_m: float) -> None:
    """In closed form: the first from 100 m at 2 m/s, losing 0.05 m/s²; the second from there at 4 m/s, 15 s later. Both
    weigh the same, so they go on at the mean of both speeds and lose the mean of both decelerations."""
    rolls = braked_m_s2((0.05, second_m_s2))
    standing, lanes, length = StandingCars(np.array([[free_m]]), rolls), np.array([0]), np.array([LENGTH_M])
    one, other = (Cars(rolls, np.array([row]), np.array([0])) for row in (0, 1))
    ends = moving(min(140.0, free_m), 0.0, 40.0)
    assert len(standing.add(lanes, one, moving(100.0, 2.0, 0.0), ends, length, NO_MARKS).which) == 0
    alone = moving(float(standing.free_m[0, 0]), 1.0, 40.0)
    found = standing.add(lanes, other, moving(100.0, 4.0, 15.0), alone, length, NO_MARKS)
    # 100 + 4 τ − b τ²/2 is the head, 86 + 2 (15 + τ) − 0.025 (15 + τ)² the tail, τ after 15 s
    a, b, c = 0.5 * (0.05 - second_m_s2), 4.0 - 2.0 + 0.05 * 15.0, 100.0 - (86.0 + 30.0 - 0.025 * 225.0)
    tau = (-b + np.sqrt(b * b - 4.0 * a * c)) / (2.0 * a) if a else -c / b
    first, second = 2.0 - 0.05 * (15.0 + tau), 4.0 - second_m_s2 * tau
    head = 100.0 + 4.0 * tau - 0.5 * second_m_s2 * tau**2 + LENGTH_M
    speed, slows = 0.5 * (first + second), 0.5 * (0.05 + second_m_s2)
    stop = head + speed**2 / (2.0 * slows)
    assert found.which.tolist() == [0]
    assert found.members.tolist() == [[0, 1]]
    assert found.contact.time_s[0] == pytest.approx(15.0 + tau, abs=0.03)
    assert found.head_m[0] == pytest.approx(head, abs=0.05)
    assert found.speed_m_s[0] == pytest.approx(speed, abs=2e-3)
    assert found.end_m[0] == pytest.approx(min(stop, free_m), abs=0.05 + 2e-3 * speed / slows)
    assert found.end_m_s[0] == pytest.approx(np.sqrt(max(speed**2 - 2.0 * slows * (free_m - head), 0.0)), abs=5e-3)
    assert standing.free_m[0, 0] == pytest.approx(found.end_m[0] - 2.0 * LENGTH_M)
    assert (stop > free_m) == (free_m == 180.0)


def test_a_third_cut_pushes_both() -> None:
    """Momentum and resistance of three that weigh the same: thirds."""
    rolls = braked_m_s2((0.05, 0.05, 0.0))
    standing, lanes, length = StandingCars(np.array([[500.0]]), rolls), np.array([0]), np.array([LENGTH_M])
    for row, (speed, start) in enumerate(((2.0, 0.0), (4.0, 15.0), (4.0, 24.0))):
        cut, ends = Cars(rolls, np.array([row]), np.array([0])), moving(140.0, 0.0, 60.0)
        found = standing.add(lanes, cut, moving(100.0, speed, start), ends, length, NO_MARKS)
    assert found.members.tolist() == [[0, 1, 2]]
    both, third = found.contact.ahead_m_s[0], found.contact.behind_m_s[0]
    assert found.speed_m_s[0] == pytest.approx((2.0 * both + third) / 3.0)
    assert found.head_m[0] == pytest.approx(found.contact.head_m[0] + 2.0 * LENGTH_M)
    slows = 0.1 / 3.0
    assert found.end_m[0] == pytest.approx(found.head_m[0] + found.speed_m_s[0] ** 2 / (2.0 * slows))
    assert standing.free_m[0, 0] == pytest.approx(found.end_m[0] - 3.0 * LENGTH_M)
