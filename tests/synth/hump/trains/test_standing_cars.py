"""Cuts on their tracks: those that catch another while it rolls, and what is seen to be free."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from synth.hump.trains.coupling_on_track import OnTrack, closing_speed_m_s
from synth.hump.trains.motion import Cars, Moving
from synth.hump.trains.standing_cars import StandingCars
from tests.synth.hump.trains.bare_cuts import GRAVITY_M_S2, EvenFall

Floats = NDArray[np.float64]

LENGTH_M = 14.0

NEVER = np.array([np.inf])


def cars(resisted: float = 0.0, row: int = 0) -> Cars:
    """One cut on flat track, which resistance slows down."""
    return Cars(EvenFall(0.0, np.full(row + 1, resisted)), np.array([row]), np.array([0]))


def moving(head_m: float, speed_m_s: float, time_s: float) -> Moving:
    """One cut."""
    return Moving(np.array([head_m]), np.array([speed_m_s]), np.array([time_s]))


def closing(ahead: Moving, behind: Moving, ends_m: tuple[float, float], resisted: tuple[float, float]) -> float:
    """Of two cuts, the first one 14 m long."""
    one = OnTrack(cars(resisted[0]), ahead, np.array([ends_m[0]]), NEVER)
    other = OnTrack(cars(resisted[1]), behind, np.array([ends_m[1]]), NEVER)
    return float(closing_speed_m_s(one, other, np.array([LENGTH_M]))[0])


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
    standing = StandingCars(np.array([[130.0]]))
    first = standing.add(np.array([0]), cars(), moving(118.0, 1.0, 0.0), moving(130.0, 1.0, 12.0), np.array([LENGTH_M]))
    assert np.isnan(first).all()
    later = moving(108.0, 1.5, 8.0), moving(116.0, 1.5, 8.0 + 8.0 / 1.5)
    assert np.isnan(standing.add(np.array([0]), cars(row=1), *later, np.array([LENGTH_M]))).all()
    assert standing.free_m.tolist() == [[130.0 - 2.0 * LENGTH_M]]


def test_what_is_free_is_seen_as_it_was_at_the_time() -> None:
    """A cut that rolls is taken to couple, also by one behind another that still rolls; when it stands, one sees its
    gap."""
    standing, lanes, routes = StandingCars(np.array([[400.0]])), np.array([0]), np.array([0])
    resisted = 0.1 / GRAVITY_M_S2

    def seen(now_s: float) -> float:
        return float(standing.seen_m(lanes, routes, np.array([now_s]))[0])

    assert seen(0.0) == 400.0
    length = np.array([LENGTH_M])
    standing.add(lanes, cars(resisted), moving(100.0, 2.0, 10.0), moving(120.0, 0.0, 30.0), length)
    assert seen(29.0) == 400.0 - LENGTH_M
    assert seen(30.0) == 120.0 - LENGTH_M
    standing.add(lanes, cars(resisted, 1), moving(80.0, 1.0, 25.0), moving(85.0, 0.0, 35.0), length)
    assert seen(29.0) == 400.0 - 2.0 * LENGTH_M
    assert seen(35.0) == 85.0 - LENGTH_M


def test_cuts_that_do_not_come_by_themselves_take_room() -> None:
    standing = StandingCars(np.array([[400.0, 300.0]]))
    standing.block(np.array([0]), np.array([1]), np.array([LENGTH_M]))
    assert standing.free_m.tolist() == [[400.0, 300.0 - LENGTH_M]]
