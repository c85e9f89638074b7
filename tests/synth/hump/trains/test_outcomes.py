"""Outcomes of trains, and their file.

What trains came to, counted by hand on a small memory; and how much of the tracks is free before.
trains.npz: numpy reads it, and what is damaged or forged is refused before it takes memory.
"""

from __future__ import annotations

import io
import tracemalloc
import zipfile
from collections.abc import Callable
from dataclasses import fields
from functools import cache

import numpy as np
import pytest

from plant_models.library import load_hump
from synth.hump.configuration.settings import TracksSettings
from synth.hump.rolling.hump_routes import HumpRoutes, hump_routes
from synth.hump.rolling.outcomes import (
    GAP_BINS_M,
    SPEED_BINS_M_S,
    PassLimits,
    TrainOutcomes,
    histograms,
    joined,
    outcomes,
)
from synth.hump.rolling.train_memory import TrainMemory
from synth.hump.trains.outcome_file import TrialTrains, from_npz, to_npz
from synth.hump.trial.tracks_between import SPARE_M, free_before_m, with_room
from tests.plant_models.rolling.populations import population
from tests.synth.hump.trains.bare_cuts import LEAD, BareTrains, one_switch
from tests.synth.hump.trains.made_trials import CATEGORIES, Day
from tuning_tables import DamagedTable
from tuning_tables.whole_file import seal_of

LENGTH_M = np.array([[14.0, 28.0, 14.0, 14.0, 42.0, 14.0]])
NONE, SWITCH, BRAKE = 2, 0, 1


class CountedTrains(BareTrains):
    """With numbers of cars."""

    cars = np.array([1, 2, 1, 1, 3, 1])
    population = population()
    category = np.array([0, 4, 0, 4, 0, 0])


def memory_of_six(routes: HumpRoutes) -> TrainMemory:
    """Six cuts: coupled at 1.6 m/s; left a gap of 25 m; misrouted; in contact in the last position; stopped in it;
    caught the one ahead at 0 m/s while that rolled."""
    memory = TrainMemory(1, 6, routes)
    memory.route[:] = [0, 1, 0, 1, 0, 1]
    memory.crest_s[:] = [0.0, 8.0, 16.0, 22.0, 34.0, 46.0]
    memory.hump_speed_m_s[:] = 2.5
    memory.misrouted_at[0, 2] = SWITCH
    memory.contact_at[0, 3] = BRAKE
    memory.unseparated[0, 2, SWITCH] = memory.unseparated[0, 3, BRAKE] = memory.foul[0, 2, SWITCH] = True
    memory.free_m[:] = [500.0, 480.0, 400.0, np.nan, 450.0, 440.0]
    memory.free_m[0, 0] = routes.standing_from_m[0] + 13.0
    memory.found_free_m[:] = routes.standing_from_m + 0.75 * (routes.length_m - routes.standing_from_m)
    memory.pulled[:] = 2
    memory.end_m[:] = [500.0, 455.0, 400.0, np.nan, 90.0, 430.0]
    memory.end_speed_m_s[:] = [1.6, 0.0, 3.0, np.nan, 0.0, 0.0]
    memory.caught_on_track[0, 5] = True
    memory.command_m_s[0, :, 0] = [2.0, 2.0, 2.0, np.nan, 1.0, 2.0]
    memory.unbraked_m_s[0, :, 0] = [2.5, 4.0, 2.0, np.nan, np.nan, 2.1]
    memory.exit_m_s[0, :, 0] = [2.5, 1.5, 2.0, np.nan, np.nan, 2.0]
    memory.strokes[0, :, 0] = [4, 3, 2, 0, 0, 1]
    return memory


def test_six_cuts_are_counted_by_hand() -> None:
    routes = hump_routes(one_switch(), LEAD)
    trains = CountedTrains(routes, np.array([[1, 2, 1, 2, 1, 2]]), LENGTH_M, first=7)
    lowest = np.array([1.5, 2.0, 2.0, 1.0, 1.0, 2.0])[:, None]
    able = PassLimits(lowest, np.array([2.0, 99.0, 99.0, 99.0, 99.0, 99.0])[:, None])
    found = outcomes(routes, trains, memory_of_six(routes), able)  # type: ignore[arg-type]  # bare trains
    counts = {f.name: getattr(found, f.name).tolist()[0] for f in fields(TrainOutcomes) if "bins" not in f.name}
    assert counts == {
        "train": 7,
        "shift": 7,
        "occupied": 0.25,
        "pushed_up": 0,
        "pulled": 2,
        "no_room": 1,
        "cuts": 6,
        "cars": 9,
        "span_s": 46.0,
        "span_m": 126.0 - 14.0,
        "span_cars": 8.0,
        "misrouted": [1, 0, 0],
        "contact": [0, 0, 1],
        "unseparated": [1, 0, 1],
        "foul": [1, 0, 0],
        "caught": 1,
        "caught_in_last": 1,
        "caught_on_track": 1,
        "stopped": 1,
        "judged": 3,
        "overspeed": [0, 1, 0],
        "gap_m": 25.0,
        "passes": [4],
        "strokes": [10],
        "error2_m2_s2": [0.5],
        "short": [1],
        "at_lowest": [3],
        "commanded": [[3, 0, 0, 0, 1]],
        "commands_m_s": [[6.0, 0.0, 0.0, 0.0, 2.0]],
        "tightest_s": 0.0,
        "tightest_at": -1,
        "tightest_ahead": 0,
        "tightest_behind": 4,
    }
    assert routes.numbers == (1, 401, 402)
    assert np.flatnonzero(found.speed_bins[0]).tolist() == [16]
    assert np.flatnonzero(found.gap_bins[0]).tolist() == [2]
    twice = joined([found, found])
    assert twice.train.tolist() == [7, 7]
    assert twice.overspeed.shape == (2, 3)


@pytest.mark.parametrize(
    ("speed", "place"), [(1.38, None), (1.39, 0), (1.5, 0), (1.51, 1), (2.0, 1), (2.01, 2), (9.0, 2)]
)
def test_classes_of_over_speeds(speed: float, place: int | None) -> None:
    routes = hump_routes(one_switch(), LEAD)
    memory = memory_of_six(routes)
    memory.end_speed_m_s[0, 0] = speed
    trains = CountedTrains(routes, np.array([[1, 2, 1, 2, 1, 2]]), LENGTH_M)
    found = outcomes(routes, trains, memory).overspeed[0]  # type: ignore[arg-type]  # bare trains
    assert found.tolist() == [int(each == place) for each in range(3)]


def test_histograms_are_those_of_numpy_with_all_beyond_in_the_last_bin() -> None:
    random = np.random.default_rng(2)
    values = random.uniform(0.0, 6.0, (3, 50))
    values[random.random(values.shape) < 0.3] = np.nan
    found = histograms(values, SPEED_BINS_M_S)
    for row, own in zip(found, values, strict=True):
        np.testing.assert_array_equal(row, np.histogram(own[~np.isnan(own)], SPEED_BINS_M_S)[0])
    assert histograms(np.array([[601.0, 600.0, 595.0]]), GAP_BINS_M)[0, -1] == 3


def test_free_tracks_are_drawn_evenly_and_are_the_same_in_any_batch() -> None:
    routes = hump_routes(load_hump("large").graph, 201)
    begins = np.array([route.yard_from_m for route in routes.routes])
    drawn_between = TracksSettings(free_low=0.3, free_high=0.7)
    drawn = free_before_m(drawn_between, routes, 5, 0, 400)
    share = (drawn - begins) / (routes.length_m - begins)
    assert share.min() > 0.3
    assert share.max() < 0.7
    assert abs(share.mean() - 0.5) < 4.0 * 0.4 / np.sqrt(12 * share.size)
    assert abs(share.std() - 0.4 / np.sqrt(12)) < 0.002
    np.testing.assert_array_equal(free_before_m(drawn_between, routes, 5, 37, 3), drawn[37:40])
    as_in_file = free_before_m(TracksSettings(standing="file"), routes, 5, 0, 2)
    np.testing.assert_array_equal(as_in_file, np.tile(routes.length_m, (2, 1)))


def test_a_track_has_room_for_all_that_go_there_as_far_as_it_is_long_enough() -> None:
    trial = Day(cuts=30, cars_mean=3.0, most_cars=10, tracks={1: 1.0, 2: 1.0, 5: 1.0}).on()
    trains, routes = trial.source.trains(0, 8), trial.routes
    begins = np.array([route.yard_from_m for route in routes.routes])
    given = np.tile(begins + 100.0, (8, 1))
    given[:, 3] = routes.length_m[3]
    found = with_room(routes, trains, given)
    for train in range(8):
        for route in range(len(routes.routes)):
            own = slice(train * 30, train * 30 + 30)
            needs = sum(trains.length_m[own][trains.route[own] == route] + SPARE_M)
            wanted = max(begins[route] + needs, given[train, route])
            assert found[train, route] == pytest.approx(min(wanted, routes.length_m[route]))
    assert (found > given).any()
    assert (found == routes.length_m).any()


TRAINS = 3
LARGEST = 2_000_000
"""Bytes that a file may take, however it was made; these trains take a hundredth of it."""


@cache
def stored() -> tuple[TrialTrains, TrainOutcomes, bytes]:
    """Some trains and their file."""
    trial = Day(cuts=4, constant_m_s=1.5).on("medium")
    found = trial.batch(0, TRAINS)
    of = TrialTrains(trial.routes, "a" * 64, len(CATEGORIES.members))
    return of, found, to_npz(found, of)


def sealed(body: bytes) -> bytes:
    """A forger knows how to seal."""
    return body + seal_of(body)


def members() -> dict[str, bytes]:
    """The members of the archive."""
    with zipfile.ZipFile(io.BytesIO(stored()[2])) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def packed(contents: dict[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    """An archive of `contents`."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", method) as archive:
        for name, content in contents.items():
            archive.writestr(name, content)
    return file.getvalue()


def npy(array: np.ndarray) -> bytes:
    """An array as numpy stores it."""
    file = io.BytesIO()
    np.save(file, array)
    return file.getvalue()


def test_numpy_alone_reads_every_field_and_so_do_we() -> None:
    trial, found, content = stored()
    again = from_npz(content, "trains.npz", trial, TRAINS)
    with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
        for field in fields(TrainOutcomes):
            np.testing.assert_array_equal(getattr(found, field.name), arrays[field.name])
            np.testing.assert_array_equal(getattr(found, field.name), getattr(again, field.name))
            assert getattr(again, field.name).dtype == getattr(found, field.name).dtype
    assert from_npz(sealed(packed(members())), "trains.npz", trial, TRAINS).cuts.tolist() == found.cuts.tolist()


def longer(contents: dict[str, bytes]) -> bytes:
    """One field is far longer than the others, as its own head says."""
    return packed(contents | {"cuts.npy": npy(np.zeros(4_000_000, dtype=np.int64))})


def all_longer(contents: dict[str, bytes]) -> bytes:
    """All fields agree on far more trains than the trial has."""
    many = {
        name: npy(np.zeros((500_000, *np.load(io.BytesIO(content)).shape[1:]), dtype=np.int64))
        for name, content in contents.items()
        if name in ("train.npy", "cuts.npy", "cars.npy")
    }
    return packed(contents | many)


def lying_size(contents: dict[str, bytes]) -> bytes:
    """The directory tells the right size of a member that expands to more."""
    right = len(contents["cuts.npy"])
    body = bytearray(packed(contents | {"cuts.npy": contents["cuts.npy"] + bytes(40_000_000)}))
    entry = body.index(b"cuts.npy", body.index(b"PK\x01\x02")) - 46
    body[entry + 24 : entry + 28] = right.to_bytes(4, "little")
    return bytes(body)


def other_type(contents: dict[str, bytes]) -> bytes:
    """As many bytes of another type."""
    array = np.load(io.BytesIO(contents["cuts.npy"]))
    return packed(contents | {"cuts.npy": npy(array.view(np.float64))})


def one_missing(contents: dict[str, bytes]) -> bytes:
    """A field is not there."""
    return packed({name: content for name, content in contents.items() if name != "gap_m.npy"})


def packed_otherwise(contents: dict[str, bytes]) -> bytes:
    """By a method that Python has no word for."""
    body = bytearray(packed(contents))
    entry = body.index(b"PK\x01\x02")
    body[entry + 10 : entry + 12] = (97).to_bytes(2, "little")
    return bytes(body)


def of_another_trial(contents: dict[str, bytes]) -> bytes:
    """The trial is another one."""
    return packed(contents | {"trains_sha256.npy": npy(np.array("b" * 64))})


@pytest.mark.parametrize(
    "forged", [longer, all_longer, lying_size, other_type, one_missing, packed_otherwise, of_another_trial]
)
def test_a_forged_archive_is_refused_before_it_takes_memory(forged: Callable[[dict[str, bytes]], bytes]) -> None:
    content = sealed(forged(members()))
    tracemalloc.start()
    try:
        with pytest.raises(DamagedTable, match="these are not the outcomes of 3 trains of this trial"):
            from_npz(content, "trains.npz", stored()[0], TRAINS)
        assert tracemalloc.get_traced_memory()[1] < LARGEST
    finally:
        tracemalloc.stop()


def test_another_number_of_trains_is_refused() -> None:
    trial, _, content = stored()
    with pytest.raises(DamagedTable, match="not the outcomes of 4 trains"):
        from_npz(content, "trains.npz", trial, 4)
