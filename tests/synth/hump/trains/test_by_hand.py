"""Bare cars whose times are known in closed form: intervals, one switch, contact, coupling, energy."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from synth.hump.trains.hump_routes import Mark
from tests.synth.hump.trains.bare_cuts import (
    FIRST_M,
    GRAVITY_M_S2,
    LAST_M,
    LEFT_TRACK,
    LENGTH_M,
    RELAY_S,
    RIGHT_TRACK,
    THROW_S,
    Orders,
    Scene,
    one_switch,
    straight,
)

Floats = NDArray[np.float64]

PLACES_M = {0: (20.0, 50.0), 1: (80.0, 104.0)}
HALF_M = 0.5 * LENGTH_M


def rolled_s(path_m: Floats | float, speed_m_s: float, fall: float) -> Floats:
    """Time from rest of the push on an even fall."""
    end = np.sqrt(speed_m_s**2 + 2.0 * GRAVITY_M_S2 * fall * np.asarray(path_m))
    return np.asarray(2.0 * np.asarray(path_m) / (speed_m_s + end))


@pytest.mark.parametrize("fall", [0.0, 0.02])
def test_two_alike_cuts_are_as_far_apart_everywhere_as_at_the_crest(fall: float) -> None:
    """Pushed at one speed they come to each place one cut length over that speed after another; and when, is told by
    2·L/(u + v)."""
    speed = np.array([[2.0, 2.0, 2.0], [1.3, 1.3, 1.3]])
    memory = Scene(straight(), np.full((2, 3), LEFT_TRACK), Orders(speed), fall).run()
    apart = LENGTH_M / speed[:, 0]
    np.testing.assert_allclose(np.diff(memory.crest_s, axis=1), np.repeat(apart[:, None], 2, axis=1), rtol=1e-12)
    gaps = np.diff(memory.time_s, axis=1)
    np.testing.assert_allclose(gaps, np.broadcast_to(apart[:, None, None, None], gaps.shape), rtol=1e-9)
    for train in range(2):
        for element, (begin, end) in PLACES_M.items():
            for mark, place, axle in (
                (Mark.FIRST_IN, begin, FIRST_M),
                (Mark.LAST_IN, begin, LAST_M),
                (Mark.FIRST_OUT, end, FIRST_M),
                (Mark.LAST_OUT, end, LAST_M),
            ):
                expected = rolled_s(place + axle - HALF_M, speed[train, 0], fall)
                assert memory.time_s[train, 0, element, mark] == pytest.approx(float(expected), abs=1e-9)
    stays = memory.time_s[:, :-1, :, Mark.LAST_OUT] - memory.time_s[:, :-1, :, Mark.FIRST_IN]
    np.testing.assert_array_equal(memory.unseparated[:, 1:], stays > apart[:, None, None])


def test_the_train_is_pushed_evenly_between_two_cuts() -> None:
    """20 m and 14 m long, at 2 and 3 m/s: 17 m at 2.5 m/s on average."""
    memory = Scene(
        straight(),
        np.full((1, 2), LEFT_TRACK),
        Orders(np.array([[2.0, 3.0]])),
        lengths_m=np.array([[20.0, 14.0]]),
    ).run()
    assert memory.crest_s.tolist() == [[0.0, 6.8]]


def test_an_even_brake_takes_the_time_of_its_mean_speed() -> None:
    """5 → 2 m/s on 20 m of brake and 10 m of axles: 30/3.5 s; half of the path is over at v² = 14.5."""
    memory = Scene(straight(), np.array([[LEFT_TRACK]]), Orders(np.array([[5.0]]), 2.0)).run()
    begins = (82.0 + FIRST_M - HALF_M) / 5.0
    assert memory.begin_s[0, 0, 0] == pytest.approx(begins)
    assert memory.end_s[0, 0, 0] == pytest.approx(begins + 30.0 / 3.5)
    squares = 25.0 - 21.0 * (np.array([80.0 + LAST_M, 104.0 + FIRST_M]) - 82.0 - FIRST_M) / 30.0
    paths = (25.0 - squares) / 0.7
    np.testing.assert_allclose(
        memory.time_s[0, 0, 1, [Mark.LAST_IN, Mark.FIRST_OUT]],
        begins + 2.0 * paths / (5.0 + np.sqrt(squares)),
        rtol=1e-12,
    )


def energies(fall: float, resisted: float) -> tuple[Floats, Floats]:
    """(v²/2 at the end of free rolls, what fall and resistance leave of the energy before) of a braked cut."""
    speed = np.array([[4.0]])
    memory = Scene(
        straight(),
        np.array([[LEFT_TRACK]]),
        Orders(speed, 3.0),
        fall,
        resisted=np.array([[resisted]]),
        free_m=300.0,
    ).run()
    won = GRAVITY_M_S2 * (fall - resisted)
    first = 0.5 * 16.0 + won * (82.0 + FIRST_M - HALF_M)
    last = 0.5 * 9.0 + won * (300.0 - 102.0 - LAST_M)
    ends = 0.5 * np.array([memory.entry_m_s[0, 0, 0], memory.end_speed_m_s[0, 0]]) ** 2
    return ends, np.array([first, last])


@pytest.mark.parametrize(("fall", "resisted"), [(0.0, 0.0), (0.02, 0.0), (0.02, 0.018), (0.0, 0.002)])
def test_energy_is_kept_but_for_what_brake_and_resistance_take(fall: float, resisted: float) -> None:
    found, kept = energies(fall, resisted)
    np.testing.assert_allclose(found, kept, rtol=1e-9)


BASE_M = LAST_M - FIRST_M


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


def test_a_cut_that_touches_another_rolls_behind_it() -> None:
    """The first one at 1 m/s, the second one at 3: 7 s after it at the crest, and at 52.5 m it has it."""
    memory = Scene(one_switch(), np.full((1, 2), LEFT_TRACK), Orders(np.array([[1.0, 3.0]]))).run()
    assert memory.contact_at[0, 1] == 0
    ahead, behind = memory.time_s[0]
    np.testing.assert_allclose(behind[1, Mark.FIRST_IN], ahead[1, Mark.LAST_IN])
    np.testing.assert_allclose(behind[1, Mark.LAST_OUT], ahead[1, Mark.LAST_OUT] + BASE_M / 1.0, rtol=1e-9)
    assert np.isnan(memory.end_m[0, 1])


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


def test_cuts_couple_to_those_that_stand() -> None:
    """Free to 300 m; the first cut couples there at its speed, the second one a cut length earlier."""
    speeds = np.array([[3.0, 2.0]])
    memory = Scene(one_switch(), np.full((1, 2), LEFT_TRACK), Orders(speeds), free_m=300.0).run()
    assert memory.end_m.tolist() == [[300.0, 300.0 - LENGTH_M]]
    np.testing.assert_allclose(memory.end_speed_m_s, speeds)
    np.testing.assert_allclose(memory.free_m, memory.end_m)
    assert memory.end_time_s[0, 0] == pytest.approx((300.0 - HALF_M) / 3.0)
    assert not memory.caught_on_track.any()


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
