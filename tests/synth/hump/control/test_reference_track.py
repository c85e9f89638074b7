"""The track geometry of the tests against closed forms: times of axles, occupations, faults."""

from __future__ import annotations

import numpy as np
import pytest

from plant_models.errors import PlantError
from synth.hump.control.models import ENTRY, AxlePass, Occupation
from synth.hump.control.route_table import RouteTable
from tests.plant_models.hump.random_humps import small_hump
from tests.synth.hump.control.cut_motion import MovingCut, moving_cut
from tests.synth.hump.control.reference_faults import (
    NOBODY,
    CounterSlip,
    FalselyFree,
    FalselyOccupied,
    Fault,
    LateSwitch,
    StuckSwitch,
)
from tests.synth.hump.control.reference_track import ReferenceTrack

TABLE = RouteTable(small_hump())
AXLES = (0.0, 1.85, 8.65, 10.5)
CUT = moving_cut(4, AXLES, 2.0, [(40.0, 4.0), (120.0, 5.0), (400.0, 2.5)])


def arrivals(place_m: float) -> list[float]:
    """When the axles of CUT are at a place, leg by leg by hand."""
    times = []
    for axle in AXLES:
        at = place_m + axle
        times.append(2.0 + min(at, 40.0) / 4.0 + max(min(at, 120.0) - 40.0, 0.0) / 5.0 + max(at - 120.0, 0.0) / 2.5)
    return times


def passes(faults: tuple[Fault, ...] = (), right: bool = True) -> list[AxlePass]:
    """Every axle over every counter; switch 1 is thrown right at once."""
    track = ReferenceTrack(TABLE, [CUT], faults)
    track.advance(0.0)
    if right:
        track.throw(1, 1)
    found: list[AxlePass] = []
    for second in range(1, 200):
        track.advance(float(second))
        found += track.axles()
    return found


def test_axles_pass_counters_when_the_tables_say() -> None:
    """Switch 1 from 34 to 52 m, right; retarder 401 from 98 to 128 m; switch 2 from 154 to 172 m, left; track 2."""
    expected = [
        *((time, 1, ENTRY) for time in arrivals(34.0)), *((time, 1, 1) for time in arrivals(52.0)),
        *((time, 401, ENTRY) for time in arrivals(98.0)), *((time, 401, 0) for time in arrivals(128.0)),
        *((time, 2, ENTRY) for time in arrivals(154.0)), *((time, 2, 0) for time in arrivals(172.0)),
        *((time, 602, ENTRY) for time in arrivals(220.0)),
    ]  # fmt: skip
    found = passes()
    assert [(p.element, p.end) for p in found] == [(element, end) for _, element, end in sorted(expected)]
    assert [p.time_s for p in found] == pytest.approx([time for time, _, _ in sorted(expected)], abs=1e-9)


def test_points_decide_where_the_first_axle_goes() -> None:
    assert {p.element for p in passes(right=False)} == {1, 601}
    assert {p.element for p in passes((StuckSwitch(1, 0.0, 1.0),))} == {1, 601}
    # The first axle is at the points, 40 m, at 12 s; the throw takes 0.8 s.
    assert {p.element for p in passes((LateSwitch(1, 11.1),))} == {1, 401, 2, 602}
    assert {p.element for p in passes((LateSwitch(1, 11.3),))} == {1, 601}


@pytest.mark.parametrize(("change", "times"), [(-1, 0), (1, 2)])
def test_a_counter_slips_at_the_axle_it_is_told(change: int, times: int) -> None:
    right, found = passes(), passes((CounterSlip(401, ENTRY, 2, change),))
    at = next(p for p in right if p == AxlePass(arrivals(98.0)[2], 401, ENTRY))
    assert found.count(at) == times
    assert [p for p in found if p != at] == [p for p in right if p != at]


def seen(faults: tuple[Fault, ...], sees_axles: bool) -> list[tuple[float, tuple[int, ...]]]:
    """What switch 1 tells, by time."""
    track = ReferenceTrack(TABLE, [moving_cut(4, (0.0, 20.0), 0.0, [(400.0, 2.0)])], faults, sees_axles)
    found = []
    for tick in range(1000):
        track.advance(0.1 * tick)
        found += [(round(0.1 * tick, 1), o.objects) for o in track.occupations() if o.element == 1]
    return found


def test_a_circuit_sees_axles_and_the_published_model_sees_cuts() -> None:
    """Two axles 20 m apart at 2 m/s over 18 m: on it from 17 to 26 s and from 27 to 36 s."""
    assert seen((), True) == [(17.0, (4,)), (26.0, ()), (27.0, (4,)), (36.0, ())]
    assert seen((), False) == [(17.0, (4,)), (36.0, ())]


def test_a_section_lies_between_two_times() -> None:
    assert seen((FalselyFree(1, 18.0, 20.0),), False) == [(17.0, (4,)), (18.0, ()), (20.0, (4,)), (36.0, ())]
    assert seen((FalselyOccupied(1, 5.0, 20.0),), False) == [
        (5.0, (NOBODY,)), (17.0, (NOBODY, 4)), (20.0, (4,)), (36.0, ()),
    ]  # fmt: skip


def test_throwing_under_a_cut_is_seen_and_where_it_is_and_how_fast() -> None:
    track = ReferenceTrack(TABLE, [CUT])
    thrown = []
    for tick in range(400):
        track.advance(0.1 * tick)
        before = len(track.truth.thrown_under)
        track.throw(1, tick % 2)
        thrown += [0.1 * tick] * (len(track.truth.thrown_under) > before)
    # From the first axle in, at 34 m, to the last one out, at 52 m.
    assert thrown[0] == pytest.approx(arrivals(34.0)[0], abs=0.1)
    assert thrown[-1] == pytest.approx(arrivals(52.0)[3], abs=0.1)
    assert track.place_m(4) == pytest.approx(CUT.place_m(39.9))
    assert [CUT.speed_m_s(time) for time in (0.0, 3.0, 15.0, 100.0, 1000.0)] == [0.0, 4.0, 5.0, 2.5, 0.0]
    assert CUT.place_m(17.0) == pytest.approx(65.0)


def test_points_are_detected_on_their_way_and_at_home() -> None:
    track = ReferenceTrack(TABLE, [])
    track.advance(0.0)
    assert dict(track.positions()) == {1: 0, 2: 0}
    track.throw(1, 1)
    told = []
    for tick in range(1, 12):
        track.advance(0.1 * tick)
        told += [(round(0.1 * tick, 1), *each) for each in track.positions()]
    assert told == [(0.1, 1, -1), (0.8, 1, 1)]
    assert list(track.occupations()) == list[Occupation]()
    assert track.is_empty()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"cut": 0}, "its number is 0"),
        ({"axles_m": np.array([1.0, 2.0])}, "first axle must be at 0"),
        ({"axles_m": np.array([0.0, 0.0])}, "axles_m must be finite numbers that rise"),
        ({"times_s": np.array([0.0, np.inf])}, "times_s must be finite"),
        ({"places_m": np.array([0.0])}, "two places and times"),
    ],
)
def test_what_cannot_move_is_refused(change: dict[str, object], words: str) -> None:
    given = {"cut": 1, "axles_m": np.array([0.0]), "times_s": np.array([0.0, 1.0]), "places_m": np.array([0.0, 1.0])}
    with pytest.raises(PlantError, match=words):
        MovingCut(**{**given, **change})  # type: ignore[arg-type]  # wrong on purpose
    with pytest.raises(PlantError, match="a speed is 0 m/s"):
        moving_cut(1, (0.0,), 0.0, [(10.0, 0.0)])
    with pytest.raises(PlantError, match="change is 2"):
        CounterSlip(1, 0, 0, 2)
