"""Fall of a track, and what no track can be."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plant_models import PlantError, TrackProfile
from plant_models.rolling.roll_track import Bend, RollTrack
from plant_models.rolling.weather import Weather

TRACK = RollTrack(TrackProfile((0.0, 40.0, 100.0), (45.0, 10.0, -2.0)), 160.0)


def test_the_fall_is_the_sum_of_grades_times_lengths() -> None:
    at = np.array([-30.0, 0.0, 20.0, 40.0, 70.0, 100.0, 130.0, 160.0, 500.0])
    np.testing.assert_allclose(TRACK.fall_m(at), [0.0, 0.0, 0.9, 1.8, 2.1, 2.4, 2.34, 2.28, 2.28], atol=1e-12)
    assert TRACK.breaks_m == (0.0, 40.0, 100.0, 160.0)


@given(st.lists(st.tuples(st.floats(1.0, 200.0), st.floats(-20.0, 60.0)), min_size=1, max_size=8))
def test_the_slope_of_the_fall_is_the_grade_of_the_profile(elements: list[tuple[float, float]]) -> None:
    starts = np.concatenate(([0.0], np.cumsum([length for length, _ in elements])))
    profile = TrackProfile(tuple(starts[:-1].tolist()), tuple(grade for _, grade in elements))
    track = RollTrack(profile, float(starts[-1]))
    x = np.linspace(0.0, starts[-1], 4001)
    slope = 1e3 * np.diff(track.fall_m(x)) / np.diff(x)
    middle = 0.5 * (x[:-1] + x[1:])
    whole = np.min(np.abs(middle[:, None] - starts), axis=1) > np.diff(x)[0]
    np.testing.assert_allclose(slope[whole], profile.grade_permille(middle[whole]), atol=1e-6)


@pytest.mark.parametrize(
    ("faulty", "sentence"),
    [
        (lambda: RollTrack(TrackProfile((5.0,), (1.0,)), 100.0), "track: starts_m is (5.0,); it must begin with 0"),
        (
            lambda: RollTrack(TrackProfile((0.0, 50.0), (1.0, 1.0)), 50.0),
            "begins at 50 m; it must begin before the end",
        ),
        (lambda: RollTrack(TrackProfile((0.0,), (1.0,)), -5.0), "track: end_m is -5.0; it must be a finite number"),
        (lambda: RollTrack(TrackProfile((0.0,), (1.0,)), np.inf), "track: end_m is inf; it must be a finite number"),
        (lambda: TrackProfile((0.0,), (100.0,)), "grades_permille is 100.0; it must be a finite number from -60 to 60"),
        (lambda: Bend(30.0, 20.0, 1, 0.0), "bend: to_m is 20; it must be more than from_m, 30"),
        (lambda: Bend(-1.0, 20.0, 1, 0.0), "bend: from_m is -1.0; it must be a finite number from 0"),
        (lambda: Bend(1.0, 20.0, 0, 0.0), "switches and turn_deg are both 0 at 1 m"),
        (lambda: Bend(1.0, 20.0, 21, 0.0), "bend: switches is 21; it must be from 0 to 20"),
        (lambda: Bend(1.0, 20.0, 1, 400.0), "bend: turn_deg is 400.0; it must be a finite number from 0 to 360"),
        (
            lambda: RollTrack(TRACK.profile, 160.0, (Bend(10.0, 30.0, 1, 0.0), Bend(29.0, 40.0, 1, 0.0))),
            "the bend from 29 m overlaps the one that ends at 30 m",
        ),
        (
            lambda: RollTrack(TRACK.profile, 160.0, (Bend(150.0, 170.0, 1, 0.0),)),
            "the last bend ends at 170 m, after the end of the track, 160 m",
        ),
        (lambda: Weather(temperature_c=-80.0), "weather: temperature_c is -80.0; it must be a finite number from -60"),
        (lambda: Weather(head_wind_mean_m_s=40.0), "weather: head_wind_mean_m_s is 40.0"),
        (lambda: Weather(head_wind_std_m_s=-1.0), "weather: head_wind_std_m_s is -1.0; it must be a finite number"),
        (
            lambda: Weather(snow_n_per_kn=11.0),
            "weather: snow_n_per_kn is 11.0; it must be a finite number from 0 to 10",
        ),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence(faulty, sentence: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(PlantError) as found:
        faulty()
    assert sentence in str(found.value)
    assert "\n" not in str(found.value)


def test_bends_may_touch() -> None:
    assert (
        RollTrack(TRACK.profile, 160.0, (Bend(10.0, 30.0, 1, 0.0), Bend(30.0, 160.0, 1, 0.0))).bends[1].from_m == 30.0
    )
