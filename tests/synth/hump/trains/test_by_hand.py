"""Humping in closed form.

Bare cars at one switch, whose times are known in closed form: late points, a stop, a fouled fouling point.
Cuts on their tracks: those that touch and roll on as one, and what is seen to be free.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from synth.hump.rolling.hump_routes import Mark
from synth.hump.rolling.motion import Cars, Moving
from synth.hump.rolling.standing_cars import StandingCars
from tests.synth.hump.trains.bare_cuts import (
    FIRST_M,
    GRAVITY_M_S2,
    LAST_M,
    LEFT_TRACK,
    LENGTH_M,
    RELAY_S,
    RIGHT_TRACK,
    THROW_S,
    EvenFall,
    Orders,
    Scene,
    one_switch,
)

Floats = NDArray[np.float64]
HALF_M = 0.5 * LENGTH_M


def speeds_for(extra_s: float) -> tuple[Floats, float]:
    """Hump speed of the second cut so that it comes `extra_s` later than needed behind a first one at 2 m/s."""
    low, high = 0.5, 4.0
    for _ in range(100):
        speed = 0.5 * (low + high)
        crest = 2.0 * LENGTH_M / (2.0 + speed)
        comes = crest + (40.0 + FIRST_M - HALF_M) / speed
        out = (51.0 + LAST_M - HALF_M) / 2.0
        low, high = (low, speed) if comes - out - THROW_S - RELAY_S < extra_s else (speed, high)
    return np.array([[2.0, speed]]), comes


@pytest.mark.parametrize("extra_s", [0.001, -0.001])
def test_points_are_thrown_in_time_or_late_by_a_millisecond(extra_s: float) -> None:
    speeds, comes = speeds_for(extra_s)
    memory = Scene(one_switch(), np.array([[LEFT_TRACK, RIGHT_TRACK]]), Orders(speeds)).run()
    assert memory.time_s[0, 1, 0, Mark.FIRST_IN] == pytest.approx(comes, abs=1e-9)
    late = extra_s < 0.0
    assert memory.misrouted_at.tolist() == [[3, 0 if late else 3]] or memory.misrouted_at[0, 1] == (0 if late else 2)
    assert memory.route[0, 1] == (memory.route[0, 0] if late else 1 - memory.route[0, 0])
    assert memory.contact_at[0, 1] == 2
    assert not memory.unseparated[0, 1, 0]


@pytest.mark.parametrize("extra_s", [-0.001, -0.5])
def test_points_that_lie_right_need_no_throw(extra_s: float) -> None:
    speeds, _ = speeds_for(extra_s)
    memory = Scene(one_switch(), np.full((1, 2), RIGHT_TRACK), Orders(speeds)).run()
    assert memory.misrouted_at.tolist() == [[2, 2]]
    assert (memory.route == memory.route[0, 0]).all()


def test_between_a_throw_and_none_a_cut_is_separated_and_yet_late() -> None:
    """0.5 s behind: the section is free, but the points are still on their way."""
    speeds, _ = speeds_for(0.5 - THROW_S - RELAY_S)
    memory = Scene(one_switch(), np.array([[LEFT_TRACK, RIGHT_TRACK]]), Orders(speeds)).run()
    assert memory.misrouted_at[0, 1] == 0
    assert not memory.unseparated[0, 1, 0]
    closer, _ = speeds_for(-0.1 - THROW_S - RELAY_S)
    memory = Scene(one_switch(), np.array([[LEFT_TRACK, RIGHT_TRACK]]), Orders(closer)).run()
    assert memory.unseparated[0, 1, 0]


def test_a_cut_that_stops_blocks_the_switch() -> None:
    """10 ‰ against 2 m/s: it stops after 4/(2·9.5·0.01) = 21.05 m, with its head at 28.05 m, and the first axle of the
    second one, of 2.1 m/s, does not come to the switch either; on 5 ‰ it stops at 49.1 m, on the switch."""
    resisted = np.array([[0.005, 0.0]])
    scene = Scene(
        one_switch(), np.array([[LEFT_TRACK, RIGHT_TRACK]]), Orders(np.array([[2.0, 2.0]])), resisted=resisted
    )
    memory = scene.run()
    assert memory.end_m[0, 0] == pytest.approx(HALF_M + 4.0 / (2.0 * GRAVITY_M_S2 * 0.005))
    assert np.isinf(memory.time_s[0, 0, 0, Mark.LAST_OUT])
    assert memory.misrouted_at[0, 1] == 0
    assert memory.contact_at[0, 1] == 0


@pytest.mark.parametrize(("stops_m", "foul"), [(70.0, True), (85.0, False)])
def test_a_cut_that_stands_short_of_the_fouling_point_is_fouled(stops_m: float, foul: bool) -> None:
    """The first one stops with its head there, its last axle 12 m behind it: out of the switch at 51 m, and ahead of
    the fouling point at 72 m, or beyond. The second one comes late enough for the points to be thrown."""
    resisted = 9.0 / (2.0 * GRAVITY_M_S2 * (stops_m - HALF_M))
    memory = Scene(
        one_switch(),
        np.array([[LEFT_TRACK, RIGHT_TRACK]]),
        Orders(np.array([[3.0, 0.3]])),
        resisted=np.array([[resisted, 0.0]]),
    ).run()
    assert memory.end_m[0, 0] == pytest.approx(stops_m)
    assert (memory.route[0, 1], memory.contact_at[0, 1]) == (1 - memory.route[0, 0], 2)
    assert memory.foul[0, 1].tolist() == [foul, False]


CUT_M = 14.0
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


def test_one_that_stands_before_the_other_comes_is_not_caught_rolling() -> None:
    standing = StandingCars(np.array([[130.0]]), cars(row=1).rolls)
    first = standing.add(
        np.array([0]), cars(), moving(118.0, 1.0, 0.0), moving(130.0, 1.0, 12.0), np.array([CUT_M]), NO_MARKS
    )
    assert len(first.which) == 0
    later = moving(108.0, 1.5, 8.0), moving(116.0, 1.5, 8.0 + 8.0 / 1.5)
    assert len(standing.add(np.array([0]), cars(row=1), *later, np.array([CUT_M]), NO_MARKS).which) == 0
    assert standing.free_m.tolist() == [[130.0 - 2.0 * CUT_M]]


def test_what_is_free_is_seen_as_it_was_at_the_time() -> None:
    """A cut that rolls is taken to couple, also by one behind another that still rolls; when it stands, one sees its
    gap."""
    standing, lanes, routes = StandingCars(np.array([[400.0]]), cars(row=1).rolls), np.array([0]), np.array([0])
    resisted = 0.1 / GRAVITY_M_S2

    def seen(now_s: float) -> float:
        return float(standing.seen_m(lanes, routes, np.array([now_s]))[0])

    assert seen(0.0) == 400.0
    length = np.array([CUT_M])
    standing.add(lanes, cars(resisted), moving(100.0, 2.0, 10.0), moving(120.0, 0.0, 30.0), length, NO_MARKS)
    assert seen(29.0) == 400.0 - CUT_M
    assert seen(30.0) == 120.0 - CUT_M
    standing.add(lanes, cars(resisted, 1), moving(80.0, 1.0, 25.0), moving(85.0, 0.0, 35.0), length, NO_MARKS)
    assert seen(29.0) == 400.0 - 2.0 * CUT_M
    assert seen(35.0) == 85.0 - CUT_M


def test_cuts_that_do_not_come_by_themselves_take_room() -> None:
    standing = StandingCars(np.array([[400.0, 300.0]]), cars().rolls)
    standing.block(np.array([0]), np.array([1]), np.array([CUT_M]))
    assert standing.free_m.tolist() == [[400.0, 300.0 - CUT_M]]


def braked_m_s2(slowed: tuple[float, ...]) -> EvenFall:
    """Cuts on flat track that lose so much speed in a second."""
    return EvenFall(0.0, np.array(slowed) / GRAVITY_M_S2)


@pytest.mark.parametrize(("second_m_s2", "free_m"), [(0.01, 400.0), (0.05, 400.0), (0.01, 180.0)])
def test_two_cuts_that_touch_roll_on_with_their_momentum(second_m_s2: float, free_m: float) -> None:
    """In closed form: the first from 100 m at 2 m/s, losing 0.05 m/s²; the second from there at 4 m/s, 15 s later. Both
    weigh the same, so they go on at the mean of both speeds and lose the mean of both decelerations."""
    rolls = braked_m_s2((0.05, second_m_s2))
    standing, lanes, length = StandingCars(np.array([[free_m]]), rolls), np.array([0]), np.array([CUT_M])
    one, other = (Cars(rolls, np.array([row]), np.array([0])) for row in (0, 1))
    ends = moving(min(140.0, free_m), 0.0, 40.0)
    assert len(standing.add(lanes, one, moving(100.0, 2.0, 0.0), ends, length, NO_MARKS).which) == 0
    alone = moving(float(standing.free_m[0, 0]), 1.0, 40.0)
    found = standing.add(lanes, other, moving(100.0, 4.0, 15.0), alone, length, NO_MARKS)
    # 100 + 4 τ − b τ²/2 is the head, 86 + 2 (15 + τ) − 0.025 (15 + τ)² the tail, τ after 15 s
    a, b, c = 0.5 * (0.05 - second_m_s2), 4.0 - 2.0 + 0.05 * 15.0, 100.0 - (86.0 + 30.0 - 0.025 * 225.0)
    tau = (-b + np.sqrt(b * b - 4.0 * a * c)) / (2.0 * a) if a else -c / b
    first, second = 2.0 - 0.05 * (15.0 + tau), 4.0 - second_m_s2 * tau
    head = 100.0 + 4.0 * tau - 0.5 * second_m_s2 * tau**2 + CUT_M
    speed, slows = 0.5 * (first + second), 0.5 * (0.05 + second_m_s2)
    stop = head + speed**2 / (2.0 * slows)
    assert found.which.tolist() == [0]
    assert found.members.tolist() == [[0, 1]]
    assert found.contact.time_s[0] == pytest.approx(15.0 + tau, abs=0.03)
    assert found.head_m[0] == pytest.approx(head, abs=0.05)
    assert found.speed_m_s[0] == pytest.approx(speed, abs=2e-3)
    assert found.end_m[0] == pytest.approx(min(stop, free_m), abs=0.05 + 2e-3 * speed / slows)
    assert found.end_m_s[0] == pytest.approx(np.sqrt(max(speed**2 - 2.0 * slows * (free_m - head), 0.0)), abs=5e-3)
    assert standing.free_m[0, 0] == pytest.approx(found.end_m[0] - 2.0 * CUT_M)
    assert (stop > free_m) == (free_m == 180.0)


def test_a_third_cut_pushes_both() -> None:
    """Momentum and resistance of three that weigh the same: thirds."""
    rolls = braked_m_s2((0.05, 0.05, 0.0))
    standing, lanes, length = StandingCars(np.array([[500.0]]), rolls), np.array([0]), np.array([CUT_M])
    for row, (speed, start) in enumerate(((2.0, 0.0), (4.0, 15.0), (4.0, 24.0))):
        cut, ends = Cars(rolls, np.array([row]), np.array([0])), moving(140.0, 0.0, 60.0)
        found = standing.add(lanes, cut, moving(100.0, speed, start), ends, length, NO_MARKS)
    assert found.members.tolist() == [[0, 1, 2]]
    both, third = found.contact.ahead_m_s[0], found.contact.behind_m_s[0]
    assert found.speed_m_s[0] == pytest.approx((2.0 * both + third) / 3.0)
    assert found.head_m[0] == pytest.approx(found.contact.head_m[0] + 2.0 * CUT_M)
    slows = 0.1 / 3.0
    assert found.end_m[0] == pytest.approx(found.head_m[0] + found.speed_m_s[0] ** 2 / (2.0 * slows))
    assert standing.free_m[0, 0] == pytest.approx(found.end_m[0] - 3.0 * CUT_M)
