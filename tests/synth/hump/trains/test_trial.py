"""Trials and shifts of them.

Trials: trains do not depend on those beside them, and odd humps, cars, weather and speeds are humped, too.
Shifts: tracks keep what stands on them from train to train, as a bookkeeper of single tracks counts it.
"""

from __future__ import annotations

from dataclasses import fields, replace
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models.rolling.resistance_law import Tb10062Law
from plant_models.rolling.roll_track import Weather
from synth.frame.faults import InputError
from synth.hump.configuration.settings import TracksSettings
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.planning.speed_rules import pair_by_pair
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.rolling.outcomes import TrainOutcomes, joined, some_of
from synth.hump.trains.batch import batches, orders_of
from synth.hump.trains.shown.figures import rows
from synth.hump.trains.traced_train import one_train
from synth.hump.trains.train_figures import FIGURES, longer_shifts, ratio, shift_sums, shifts_in, train_figures
from synth.hump.trial.resolved_trial import resolve_trial
from synth.hump.trial.tracks_between import SPARE_M
from synth.hump.trial.trial import Control, HumpTrial, Sensing, Turn
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


Floats = NDArray[np.float64]
TRAINS = 5
"""Of a shift."""


def shifts_of(share: float = 0.5, trains: int = TRAINS, threads: int = 1) -> HumpTrial:
    """Trains of 12 long cuts to two tracks, which are full after two or three of them."""
    tracks = dict.fromkeys((1, 2), 1.0)
    day = Day(cuts=12, cars_mean=3.0, most_cars=6, tracks=tracks, constant_m_s=1.4, threads=threads)
    return replace(day.on("medium"), tracks=TracksSettings(shift_trains=trains, pulled_from_share=share))


@cache
def found_in(shifts: int, trains: int = TRAINS) -> TrainOutcomes:
    """The trains of so many shifts of `TRAINS` trains, or the same trains in shifts of `trains`."""
    return shifts_of(trains=trains).batch(0, shifts * TRAINS)


class Bookkeeper:
    """The tracks of one shift, car by car: where the free part of each ends, and how long all its cars are."""

    def __init__(self, routes: HumpRoutes, free_m: Floats) -> None:
        self.begins, self.most = routes.standing_from_m.tolist(), routes.length_m.tolist()
        self.free = free_m.tolist()
        self.stands = [[most - free] for most, free in zip(self.most, self.free, strict=True)]

    def write(self, routes: list[int], lengths: list[float], free_m: Floats) -> None:
        """A train has come."""
        for route, length in zip(routes, lengths, strict=True):
            self.stands[route].append(length)
        self.free = free_m.tolist()

    def clear(self, routes: list[int], lengths: list[float], share: float) -> tuple[int, int]:
        """Pull and push up for the next train, whose cuts are told; how many tracks were pushed up, and pulled."""
        pushed = pulled = 0
        for track, (begins, most) in enumerate(zip(self.begins, self.most, strict=True)):
            coming = [length + SPARE_M for route, length in zip(routes, lengths, strict=True) if route == track]
            wanted, cars = begins + sum(coming), sum(self.stands[track])
            if cars == 0.0:
                continue
            pull, push = cars >= share * (most - begins), False
            if not pull and self.free[track] < wanted:
                if most - cars > self.free[track]:
                    self.free[track], push = most - cars, True
                pull = self.free[track] < wanted
            if pull:
                self.free[track], self.stands[track], push = most, [], False
            pushed, pulled = pushed + push, pulled + pull
        return pushed, pulled


@pytest.mark.parametrize("share", [0.3, 0.6, 1.0])
def test_tracks_are_those_of_a_bookkeeper(share: float) -> None:
    """Shift by shift and train by train, where the batch has all shifts side by side."""
    trial = shifts_of(share)
    found, did = trial.batch(0, 2 * TRAINS), []
    for shift in range(2):
        number = shift * TRAINS
        book = None
        for place in range(TRAINS):
            trains = trial.source.trains(number + place, 1)
            routes, lengths = trains.route.tolist(), trains.length_m.tolist()
            if book is None:
                tracks, counts = trial.first_tracks(trains), (0, 0)
                book = Bookkeeper(trial.routes, tracks.free_m[0])
            else:
                counts = book.clear(routes, lengths, share)
                tracks = replace(tracks, free_m=np.array([book.free]))
            turn = trial.turn(trains, tracks)
            book.write(turn.memory.route[0].tolist(), lengths, turn.memory.left_free_m[0])
            assert_same(again(trial, turn, counts), some_of(found, np.array([number + place])))
            did.append(counts)
    balanced(found)
    assert (found.shift == np.repeat(np.arange(2), TRAINS)).all()
    assert sum(pulled for _, pulled in did) > 0
    assert share < 0.5 or sum(pushed for pushed, _ in did) > 0


def again(trial: HumpTrial, turn: Turn, counts: tuple[int, int]) -> TrainOutcomes:
    """What one train came to, with what the bookkeeper did before it."""
    turn.memory.pushed_up, turn.memory.pulled = (np.array([count]) for count in counts)
    return trial.outcomes(turn.trains, turn.memory)


def test_a_shift_is_the_same_in_any_batch_and_with_any_threads() -> None:
    whole, trial = found_in(3), shifts_of(threads=2)
    assert_same(joined([trial.batch(0, TRAINS), trial.batch(TRAINS, 2 * TRAINS)]), whole)
    for number in (0, 13):
        alone = one_train(trial, number)
        assert alone.number == number
        assert_same(alone.outcomes(), some_of(whole, np.array([number])))


def test_the_first_train_of_a_shift_is_one_on_tracks_of_its_own() -> None:
    alone, found = found_in(3, 1), found_in(3)
    first, others = np.arange(0, 15, TRAINS), np.delete(np.arange(15), np.arange(0, 15, TRAINS))
    for name in ("occupied", "gap_m", "overspeed", "caught", "span_s"):
        np.testing.assert_array_equal(getattr(alone, name)[first], getattr(found, name)[first])
    assert (alone.cars == found.cars).all()
    assert not found.pulled[first].any()
    assert found.pulled[others].any()
    assert (alone.occupied[others] != found.occupied[others]).all()


def test_intervals_are_those_of_whole_shifts() -> None:
    found = found_in(3)
    gap = found.gap_m.reshape(3, TRAINS).sum(axis=1), found.judged.reshape(3, TRAINS).sum(axis=1).astype(float)
    np.testing.assert_allclose(shift_sums(found, found.gap_m), gap[0])
    told = {figure.name: figure for figure in train_figures(found)}
    figure = told["gap_per_cut"]
    assert (figure.value, figure.low95, figure.high95) == pytest.approx(ratio(*gap), rel=1e-12)
    assert told["gap_per_cut"].n == 3
    assert told["occupied_share"].value == pytest.approx(found.occupied.mean())
    assert told["pulled_per_train"].value == pytest.approx(found.pulled.mean())
    assert (told["no_room"].value, told["no_room"].n) == (found.no_room.sum() / found.cuts.sum(), 180)


def test_runs_with_and_without_shifts_are_paired_by_shift() -> None:
    alone, found = found_in(3, 1), found_in(3)
    (gap,) = (each for each in FIGURES if each.name == "gap_per_cut")
    assert longer_shifts(alone, found) is longer_shifts(found, alone) is found.shift
    assert (shifts_in(alone), shifts_in(found)) == (15, 3)
    value, low, high = gap.difference(found, alone)
    assert [-each for each in gap.difference(alone, found)] == pytest.approx([value, high, low])
    sums = [[shift_sums(run, each(run), found.shift) for each in (gap.hits, gap.base)] for run in (found, alone)]
    ratios = [hits.sum() / base.sum() for hits, base in sums]
    residual = [(hits - r * base) / base.mean() for (hits, base), r in zip(sums, ratios, strict=True)]
    half = 4.302653 * np.std(residual[0] - residual[1], ddof=1) / np.sqrt(3.0)
    assert (value, low, high) == pytest.approx((ratios[0] - ratios[1], value - half, value + half), rel=1e-6)


def test_the_table_has_a_row_for_each_place() -> None:
    found = found_in(3)
    told = list(rows(found))
    assert [row["trains"] for row in told] == ["1", "2", "3", "4", "5"]
    assert told[1]["occupied_share"].value == pytest.approx(found.occupied[1::TRAINS].mean())
    long = replace(found, shift=np.zeros(15, dtype=np.int64))
    assert [row["trains"] for row in rows(long)][1:5] == ["3 to 4", "5 to 6", "7", "8"]


def test_a_batch_has_whole_shifts() -> None:
    trial = shifts_of()
    orders = list(orders_of(trial, "a" * 64, 3000))
    assert [(order.first, order.count) for order in orders] == [(0, 1250), (1250, 1250), (2500, 500)]
    assert batches(3000, TRAINS) == len(orders)


def test_a_trial_has_whole_shifts() -> None:
    text = "[trains]\nnumber = 12\n[tracks]\nshift_trains = 5\n"
    with pytest.raises(InputError, match=r"a shift has 5 trains .* take 10 or 15 trains"):
        resolve_trial(parse_trial_file(text, "my.toml"))
