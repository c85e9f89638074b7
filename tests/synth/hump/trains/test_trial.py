"""Trials: trains do not depend on those beside them, and odd humps, cars, weather and speeds are humped, too."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest

from plant_models.rolling.resistance_law import Tb10062Law
from plant_models.rolling.weather import Weather
from synth.hump.configuration.settings import TracksSettings
from synth.hump.trains.hump_speed import pair_by_pair
from synth.hump.trains.outcomes import TrainOutcomes, joined
from synth.hump.trains.train_figures import train_figures
from synth.hump.trains.trial import Control, Sensing
from tests.effort import every
from tests.synth.hump.trains.made_trials import Day

MEASURED = Control(sensing=Sensing(), slow_down_s=0.2)
STORM = Weather(-20.0, 15.0, 5.0, 5.0)


def assert_same(one: TrainOutcomes, other: TrainOutcomes) -> None:
    """To the byte."""
    for field in fields(TrainOutcomes):
        left, right = getattr(one, field.name), getattr(other, field.name)
        assert left.dtype == right.dtype
        assert left.tobytes() == right.tobytes(), field.name


@pytest.mark.parametrize(
    "day",
    [Day(cuts=6, control=MEASURED), Day(cuts=5, weather=STORM, worst_pair=True), Day(cuts=6, control=Control(False))],
    ids=["measured", "storm", "open loop"],
)
def test_a_train_is_the_same_in_any_batch_and_with_any_threads(day: Day) -> None:
    whole = day.on().batch(0, 50)
    trial = day.but(threads=2).on()
    assert_same(joined([trial.batch(0, 13), trial.batch(13, 1), trial.batch(14, 36)]), whole)


def test_trains_alone_are_those_of_a_batch_where_cuts_touch_and_push_one_another() -> None:
    trial = Day(cuts=8, tracks={1: 1.0, 2: 1.0}, constant_m_s=2.8).on("medium")
    whole = trial.batch(0, 16)
    assert_same(joined([trial.batch(number, 1) for number in range(16)]), whole)
    assert whole.caught_on_track.any()
    assert whole.contact.any()


def balanced(found: TrainOutcomes) -> None:
    """Each cut ends in one way, and nothing that is told is infinite."""
    assert (found.caught + found.caught_in_last + found.stopped + found.judged == found.cuts).all()
    assert (found.overspeed.sum(axis=1) <= found.judged).all()
    assert (found.speed_bins.sum(axis=1) + found.gap_bins.sum(axis=1) <= found.judged).all()
    assert (found.caught_on_track <= found.judged).all()
    for field in fields(TrainOutcomes):
        assert np.isfinite(getattr(found, field.name)).all(), field.name
    assert (found.gap_m >= 0.0).all()


ODD = {
    "one cut": Day(cuts=1),
    "one cut, measured": Day(cuts=1, control=MEASURED, worst_pair=True),
    "two tracks": Day(tracks={1: 1.0, 2: 1.0}, control=MEASURED),
    "one track": Day(tracks={1: 1.0}, control=MEASURED),
    "60 cars": Day(cuts=3, cars_mean=10.0, most_cars=60, control=MEASURED),
    "one slow step": Day(steps_m_s=(0.3,)),
    "too fast": Day(steps_m_s=(3.6, 4.0), control=MEASURED),
    "no error": Day(std_m_s=0.0),
    "head wind": Day(weather=Weather(-20.0, 15.0, 0.0)),
    "storm": Day(weather=STORM, law=Tb10062Law(), control=MEASURED, worst_pair=True),
    "hurricane": Day(weather=Weather(-60.0, 30.0, 15.0), control=MEASURED),
    "wind behind": Day(weather=Weather(-60.0, -30.0, 15.0), control=MEASURED),
    "deep snow": Day(weather=Weather(-20.0, 0.0, 3.0, 10.0)),
    "tb 10062": Day(law=Tb10062Law()),
    "pairs": Day(method=pair_by_pair, control=MEASURED),
    "constant": Day(constant_m_s=2.5, control=Control(False)),
    "full tracks": Day(
        cuts=20,
        cars_mean=8.0,
        most_cars=60,
        tracks={1: 1.0, 2: 1.0},
        standing=TracksSettings(free_low=0.0, free_high=0.0),
        control=MEASURED,
    ),
    "no brake": Day(heads_m=(0.0, 0.0, 0.0), control=MEASURED),
}


@pytest.mark.parametrize("name", ODD)
@pytest.mark.parametrize("hump", every(2, ["large", "dumper"]))
def test_odd_days_are_humped(name: str, hump: str) -> None:
    found = ODD[name].on(hump).batch(0, 20)
    balanced(found)
    assert (found.span_s > 0.0).all() == (ODD[name].cuts > 1)


@pytest.mark.parametrize(("hump", "lead"), [("medium", 201), ("large-two-leads", 201), ("large-two-leads", 202)])
def test_all_humps_of_the_library_are_humped(hump: str, lead: int) -> None:
    found = Day(cuts=10, control=MEASURED).on(hump, lead).batch(0, 20)
    balanced(found)
    assert found.caught.sum() <= 4
    names = [figure.name for figure in train_figures(found)]
    assert len(names) == len(set(names))


def test_a_constant_speed_is_kept() -> None:
    trains, _, memory = Day(constant_m_s=2.5).on().humped(0, 20)
    assert (memory.hump_speed_m_s == 2.5).all()
    length = trains.length_m.reshape(20, -1)
    apart = 0.5 * (length[:, 1:] + length[:, :-1])
    np.testing.assert_allclose(np.diff(memory.crest_s, axis=1), apart / 2.5, rtol=1e-12)


def test_a_feedback_only_slows_the_train_down_and_within_what_the_locomotive_can() -> None:
    """A program that is too fast makes it do so; it never falls below the lowest step."""
    day = Day(cuts=25, constant_m_s=3.2, control=Control(slow_down_s=0.5))
    trains, plan, memory = day.on().humped(0, 30)
    slower = memory.hump_speed_m_s < plan.hump_speed_m_s - 1e-9
    assert 0.02 < slower.mean() < 0.8
    assert (memory.hump_speed_m_s <= plan.hump_speed_m_s + 1e-9).all()
    assert (memory.hump_speed_m_s >= day.steps_m_s[0] - 1e-9).all()
    length = trains.length_m.reshape(30, -1)
    apart = 0.5 * (length[:, 1:] + length[:, :-1])
    gain = np.diff(memory.hump_speed_m_s**2, axis=1)
    assert (gain <= 2.0 * day.acceleration_m_s2 * apart + 1e-9).all()
    assert (gain >= -2.0 * day.acceleration_m_s2 * apart - 1e-9).all()
