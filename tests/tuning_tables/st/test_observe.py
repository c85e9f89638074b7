"""RETARDER_OBSERVE, run from its parse tree, estimates as the Python estimator does, to the last bit."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import pytest
from tuning_tables.held_numbers import HELD_NUMBERS, held_numbers

from scripts.studies.in_the_loop.controller_process import ANSWER_WORDS
from scripts.studies.in_the_loop.hard_samples import TRACK_SAMPLES, hard_samples
from scripts.studies.in_the_loop.observed import observed
from tests.tuning_tables.st.compiler import ROUNDINGS, Compiler, name_of
from tests.tuning_tables.st.conftest import program_of, texts_of
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.test_decide import loaded
from tuning_tables.golden_tracks import golden_tracks
from tuning_tables.st_source import TABLE_FILE
from tuning_tables.table_book import TableBook

Followed: TypeAlias = tuple[npt.NDArray[np.void], npt.NDArray[np.uint32]]
"""Samples in tracks, and the bits of speed and estimate after each."""

SAMPLES = 200_000
MEMBERS = (
    "PATH_M", "SPEED_M_S", "FACTOR", "EXCESS", "SPEEDVARIANCE", "FACTORCOVARIANCE", "EXCESSCOVARIANCE",
    "FACTORVARIANCE", "CROSSCOVARIANCE", "EXCESSVARIANCE", "UNSEEN", "READING_M_S", "REPEATED", "BELIEVED", "DOUBTED",
)  # fmt: skip


@pytest.fixture(scope="module")
def tracks(estimating_book: TableBook) -> Followed:
    """Samples in tracks of 100, (tracks, 100), and the bits of speed and estimate after each, (tracks, 100, 18)."""
    samples = hard_samples(estimating_book, SAMPLES, 20261123)
    samples["start"] = np.where(samples["start"] == 2, 0, samples["start"])
    # The golden tracks come first, and are of other lengths.
    samples = samples[sum(map(len, golden_tracks(estimating_book))) :]
    answers = observed(estimating_book, samples)
    return samples.reshape(-1, TRACK_SAMPLES), answers.reshape(-1, TRACK_SAMPLES, ANSWER_WORDS)


def follow(program: Program, number: int, samples: npt.NDArray[np.void]) -> npt.NDArray[np.float32]:
    """Speeds, estimates and alarms after each sample of tracks of table `number`: float32 (18, tracks, samples)."""
    table, estimate = loaded(program, number), program.new("RETARDER_ESTIMATE")
    observer, beginner = program.new("RETARDER_OBSERVE"), program.new("RETARDER_BEGIN")
    found = []
    program.call("RETARDER_BEGIN", beginner, Estimate=estimate)
    for now in samples.T:
        program.call(
            "RETARDER_OBSERVE", observer, Path_m=now["s_m"], Speed_m_s=now["v_m_s"],
            Overpressure_kpa=now["overpressure_kpa"], Table=table, Estimate=estimate,
        )  # fmt: skip
        values = [observer["OBSERVED_M_S"].value, estimate["BEGUN"].value, *(estimate[name].value for name in MEMBERS)]
        values.append(observer["ALARMS"].value)
        assert np.array_equal(observer["UNSEEN"].value, estimate["UNSEEN"].value)
        found.append([np.broadcast_to(value, now.shape).astype(np.float32) for value in values])
    return np.moveaxis(np.array(found), 0, 2)


def differing(program: Program, tracks: Followed, numbers: Iterable[int]) -> int:
    """How many samples of the tables `numbers` have another bit in speed or estimate; 0 has no sign."""
    samples, answers = tracks
    count = 0
    for number in numbers:
        here = samples["table"][:, 0] == number
        right = np.moveaxis(answers[here].view(np.float32), 2, 0).copy()
        right[-1] = np.moveaxis(answers[here], 2, 0)[-1]  # the alarm word is no float
        found = follow(program, number, samples[here])
        count += int(np.count_nonzero(~((found == right) | (np.isnan(found) & np.isnan(right))).all(axis=0)))
    return count


@pytest.mark.parametrize("compiler", ROUNDINGS, ids=name_of)
def test_hard_samples_are_estimated_alike(estimating_book: TableBook, tracks: Followed, compiler: Compiler) -> None:
    program = Program(texts_of(estimating_book)[TABLE_FILE], compiler)
    numbers = np.unique(tracks[0]["table"]).tolist()
    assert len(numbers) == len(estimating_book.tables)
    assert differing(program, tracks, numbers) == 0
    speeds = tracks[1][..., 0].view(np.float32)
    assert all(np.count_nonzero(speeds == value) > 50 for value in (-1.0, np.float32(0.2)))


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("Speed_m_s <= LargestSpeed_m_s", "Speed_m_s < LargestSpeed_m_s"),
        ("Path_m <= Farthest", "Path_m <= 1.0E6"),
        ("Overpressure_kpa <= LargestPressure_kpa", "Overpressure_kpa < LargestPressure_kpa"),
        ("Path_m >= Before", "Path_m >= -1.0E6"),
        ("Place > Table.BreakPath_m[Index]", "Place > Table.BreakPath_m[Index + 1]"),
        ("Change := Drag * Estimate.CrossCovariance;", "Change := Effect * Estimate.CrossCovariance;"),
        ("Change := Effect * PathPart;", "Change := PathPart;"),
        ("Bound := GateSquared * Total;", "Bound := Total;"),
        ("Estimate.Doubted >= Table.Doubted", "Estimate.Doubted > Table.Doubted"),
        ("Estimate.Repeated < Table.Frozen", "Estimate.Repeated <= Table.Frozen"),
        ("Change := Table.Caution * Change;", ""),
        ("Alarms := Alarms + 2;", "Alarms := Alarms + 4;"),
        ("IF Estimate.FactorVariance < 0.0", "IF Estimate.FactorVariance < 0.01"),
        ("Change := Gain * CrossPart", "Change := Gain * SpeedPart"),
        ("Unseen := Estimate.Unseen + 1.0;", "Unseen := 1.0;"),
    ],
)
def test_a_wrong_estimator_is_found(estimating_book: TableBook, tracks: Followed, right: str, wrong: str) -> None:
    text = texts_of(estimating_book)[TABLE_FILE].decode("ascii")
    assert right in text
    program = Program(text.replace(right, wrong).encode("ascii"))
    assert differing(program, tracks, [0]) > 0


def test_every_golden_track_is_estimated(estimating_book: TableBook) -> None:
    program = program_of(estimating_book)
    for track in golden_tracks(estimating_book):
        samples = np.empty((1, len(track)), [(name, "f4") for name in ("s_m", "v_m_s", "overpressure_kpa")])
        samples["s_m"], samples["v_m_s"], samples["overpressure_kpa"] = track.samples[:3]
        found = follow(program, track.number, samples)[:, 0]
        assert np.array_equal(found[0], track.estimate_m_s)
        assert np.array_equal(found[2 + MEMBERS.index("UNSEEN")], track.unseen)
        assert np.array_equal(found[-1], track.alarms)


def test_a_book_without_estimators_hands_the_speed_on(small_book: TableBook, estimating_book: TableBook) -> None:
    """The blocks have the same inputs and outputs, so that one program fits both."""
    plain, full = (program_of(book) for book in (small_book, estimating_book))
    for name in ("RETARDER_OBSERVE", "RETARDER_BEGIN", "RETARDER_DECIDE", "RETARDER_SELECT", "RETARDER_LOAD"):
        assert plain.blocks[name].inputs == full.blocks[name].inputs
        assert plain.blocks[name].references == full.blocks[name].references
    speeds = np.random.default_rng(2).integers(0, 2**32, 1000, np.uint32).view(np.float32)
    observer, estimate = plain.new("RETARDER_OBSERVE"), plain.new("RETARDER_ESTIMATE")
    plain.call(
        "RETARDER_OBSERVE", observer, Path_m=1.0, Speed_m_s=speeds, Overpressure_kpa=2.0, Table=loaded(plain, 0),
        Estimate=estimate,
    )  # fmt: skip
    assert np.array_equal(observer["OBSERVED_M_S"].value, speeds, equal_nan=True)
    assert np.array_equal(observer["UNSEEN"].value == 0.0, (speeds >= 0.0) & (speeds <= 40.0))
    assert loaded(plain, 0)["TOUCH_KPA"].value == 0.0


def test_every_table_is_loaded_with_its_estimator(estimating_book: TableBook) -> None:
    program = program_of(estimating_book)
    for number, table in enumerate(estimating_book.tables):
        held, estimator = loaded(program, number), table.estimator
        breaks = held["BREAKS"].value
        if estimator is None:
            assert (held["ESTIMATOR"].value, breaks, held["TOUCH_KPA"].value) == (-1, 0, 0.0)
            continue
        assert held["TOUCH_KPA"].value == np.float32(estimator.touch_pressure_kpa)
        assert [held[each.st.upper()].value for each in HELD_NUMBERS] == list(held_numbers(estimator))
        for name, row in zip(("BREAKPATH_M", "DRIVE", "BRAKE"), estimator.work, strict=True):
            assert np.array_equal(held[name].data[:breaks], row)


@pytest.mark.parametrize("breaks", [-32768, -1, 1, 41, 32767])
def test_a_spoilt_number_of_breaks_is_not_followed(estimating_book: TableBook, breaks: int) -> None:
    program = program_of(estimating_book)
    table, worker = loaded(program, 0), program.new("RETARDER_WORK")
    table["BREAKS"].store(breaks, None)
    observer, estimate = program.new("RETARDER_OBSERVE"), program.new("RETARDER_ESTIMATE")
    readings = {"Path_m": 1.0, "Speed_m_s": 3.0, "Overpressure_kpa": 100.0}
    program.call("RETARDER_OBSERVE", observer, **readings, Table=table, Estimate=estimate)
    assert (observer["OBSERVED_M_S"].value, observer["UNSEEN"].value) == (-1.0, 1.0)
    program.call("RETARDER_WORK", worker, Path_m=1.0, Table=table)
    assert (worker["DRIVE"].value, worker["BRAKE"].value) == (0.0, 0.0)


def test_lines_between_tables_of_two_estimators_are_not_taken(estimating_book: TableBook) -> None:
    """By `TableBook.choose`; the first two targets of the class share an estimator, the third has another."""
    for book in (estimating_book, TableBook(estimating_book.tables[::-1])):
        program = program_of(book)
        for speed in (2.5, 3.0, 3.5, 3.9):
            selector, table = program.new("RETARDER_SELECT"), program.new("RETARDER_TABLE")
            program.call("RETARDER_SELECT", selector, Layout=2, Category=1, Axles=4,
                         Commanded_m_s=np.float32(speed), Table=table)  # fmt: skip
            choice = book.choose("Л", 4, speed)
            assert selector["STATUS"].value == choice.status
            assert book is not estimating_book or choice.status == (1 if speed < 3.3 else 2)
            assert choice.table is not None
            estimator = choice.table.estimator
            assert table["TOUCH_KPA"].value == np.float32(0.0 if estimator is None else estimator.touch_pressure_kpa)
