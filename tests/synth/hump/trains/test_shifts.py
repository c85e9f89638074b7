"""Shifts: tracks keep what stands on them from train to train, as a bookkeeper of single tracks counts it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from synth.frame.input_error import InputError
from synth.hump.configuration.settings import TracksSettings
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.trains.batch import batches, orders_of
from synth.hump.trains.hump_routes import HumpRoutes
from synth.hump.trains.outcomes import TrainOutcomes, joined, some_of
from synth.hump.trains.resolved_trial import resolve_trial
from synth.hump.trains.shift_sums import longer_shifts, shift_sums, shifts_in
from synth.hump.trains.shown.shift import rows
from synth.hump.trains.traced_train import one_train
from synth.hump.trains.tracks_between import SPARE_M
from synth.hump.trains.train_figures import FIGURES, ratio, train_figures
from synth.hump.trains.trial import HumpTrial, Turn
from tests.synth.hump.trains.made_trials import Day
from tests.synth.hump.trains.test_trial import assert_same, balanced

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
