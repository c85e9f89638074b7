"""Samples of cuts where a wrong implementation of the estimator shows: readings that cannot be true, a faulty radar."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats
from scripts.studies.in_the_loop.controller_process import BEGIN, ESTIMATE_WORDS, GIVEN, ON, SAMPLE
from tuning_tables.estimator import Estimator
from tuning_tables.golden_tracks import LARGEST_OVERPRESSURE_KPA, LARGEST_SPEED_M_S, golden_tracks
from tuning_tables.table_book import TableBook

TRACK_SAMPLES: Final = 100
HARD_SHARE: Final = 0.08
"""Of the readings of each kind: path, speed, overpressure."""

GIVEN_SHARE: Final = 0.005
"""Of the samples that go on from an estimate of any bits."""

LEAP_SHARE: Final = 0.01


def hard_samples(book: TableBook, count: int, seed: int) -> NDArray[np.void]:
    """At least `count` samples, dtype SAMPLE: the golden tracks, and tracks of 100 with hard readings among them.

    Each track is of one table, mostly of one with an estimator.
    """
    rng = np.random.default_rng(seed)
    estimating = [number for number, table in enumerate(book.tables) if table.estimator is not None]
    tracks = -(-count // TRACK_SAMPLES)
    numbers = rng.integers(0, len(book.tables), tracks)
    if estimating:
        numbers = np.where(rng.random(tracks) < 0.9, rng.choice(estimating, tracks), numbers)
    parts = [golden_samples(book)]
    for number in np.unique(numbers).tolist():
        parts.append(_tracks_of(number, book.tables[number].estimator, int((numbers == number).sum()), rng))
    return np.concatenate(parts)


def golden_samples(book: TableBook) -> NDArray[np.void]:
    """The tracks that are shipped."""
    parts = []
    for track in golden_tracks(book):
        part = _empty(len(track))
        part["table"], part["start"][0] = track.number, BEGIN
        part["s_m"], part["v_m_s"], part["overpressure_kpa"] = track.samples[:3]
        parts.append(part)
    return np.concatenate(parts)


def _tracks_of(number: int, estimator: Estimator | None, tracks: int, rng: np.random.Generator) -> NDArray[np.void]:
    """`tracks` tracks of table `number`, one after the other."""
    shape = (tracks, TRACK_SAMPLES)
    found = _empty(tracks * TRACK_SAMPLES)
    found["table"] = number
    start = np.where(rng.random(shape) < GIVEN_SHARE, GIVEN, ON)
    start[:, 0] = BEGIN
    found["start"] = start.ravel()
    found["given"] = _any_words(rng, len(found))
    length_m = 40.0 if estimator is None else float(estimator.work[0, -1] - estimator.work[0, 0])
    first_m = 0.0 if estimator is None else float(estimator.work[0, 0])
    entry, fall = rng.uniform(2.0, 8.0, (tracks, 1)), rng.uniform(0.0, 0.9, (tracks, 1))
    speed = entry * (1.0 - fall * np.linspace(0.0, 1.0, TRACK_SAMPLES))
    path = np.cumsum(speed, axis=1) * (rng.uniform(0.3, 1.2, (tracks, 1)) * length_m / (entry * TRACK_SAMPLES))
    leaps = np.where(rng.random(shape) < LEAP_SHARE, rng.uniform(-30.0, 30.0, shape), 0.0)
    measured = np.maximum(speed + rng.uniform(0.0, 0.2, (tracks, 1)) * rng.standard_normal(shape), 0.0)
    measured = _with_faults(measured, rng)
    pressure = np.repeat(rng.uniform(0.0, 600.0, (tracks, 10)), TRACK_SAMPLES // 10, axis=1)
    found["s_m"] = _with_hard((first_m + path + leaps).astype(np.float32), _edges(estimator, rng, shape), rng)
    found["v_m_s"] = _with_hard(measured.astype(np.float32), _near(LARGEST_SPEED_M_S, rng, shape), rng)
    found["overpressure_kpa"] = _with_hard(
        pressure.astype(np.float32), _near(LARGEST_OVERPRESSURE_KPA, rng, shape), rng
    )
    return found


def _with_faults(measured: Floats, rng: np.random.Generator) -> Floats:
    """`measured` (tracks, samples), most tracks with a fault of the radar over some samples from any moment on.

    No reading, 0, the last one again and again, spikes, or a bias; for a few samples, many, or all that follow.
    """
    tracks, samples = measured.shape
    since = np.arange(samples) - rng.integers(1, samples, (tracks, 1))
    during = (since >= 0) & (since < rng.choice([3, 10, 30, samples], (tracks, 1)))
    last = np.take_along_axis(measured, np.argmax(since >= 0, axis=1)[:, None] - 1, axis=1)
    spikes = measured + np.where(rng.random(measured.shape) < 0.3, rng.uniform(-3.0, 3.0, measured.shape), 0.0)
    biased = measured + rng.uniform(-0.8, 0.8, (tracks, 1))
    faults = [measured, np.full_like(measured, np.nan), np.zeros_like(measured), last + 0.0 * measured, spikes, biased]
    kind = rng.integers(0, len(faults), (tracks, 1))
    return np.where(during, np.choose(kind, faults), measured)


def _with_hard(usual: NDArray[np.float32], edges: NDArray[np.float32], rng: np.random.Generator) -> Any:
    """`usual`, with some replaced by `edges`, by special numbers, or by any bits; (n,)."""
    shape = usual.shape
    special = rng.choice(SPECIAL, shape)
    kind = np.where(rng.random(shape) < HARD_SHARE, rng.integers(1, 4, shape), 0)
    wild = rng.integers(0, 2**32, shape, dtype=np.uint32).view(np.float32)
    return np.choose(kind, [usual, edges, special, wild]).ravel()


SPECIAL = np.array([np.nan, np.inf, -np.inf, 0.0, -0.0, -1.0, 1e-45, -1e-45, 1e-30, 3.4e38, -3.4e38], np.float32)


def _edges(estimator: Estimator | None, rng: np.random.Generator, shape: tuple[int, int]) -> NDArray[np.float32]:
    """Breaks, or their neighbours."""
    breaks = np.zeros(1, np.float32) if estimator is None else estimator.work[0]
    return _stepped(rng.choice(breaks, shape), rng)


def _near(limit: float, rng: np.random.Generator, shape: tuple[int, int]) -> NDArray[np.float32]:
    """The limit, its neighbours, or zero."""
    return _stepped(np.where(rng.random(shape) < 0.3, 0.0, limit).astype(np.float32), rng)


def _stepped(values: NDArray[np.float32], rng: np.random.Generator) -> NDArray[np.float32]:
    """`values`, one float32 number lower or higher, or as they are."""
    towards = rng.choice(np.array([-np.inf, np.inf, np.nan], np.float32), values.shape)
    return np.where(np.isnan(towards), values, np.nextafter(values, towards)).astype(np.float32)


def _any_words(rng: np.random.Generator, count: int) -> NDArray[np.uint32]:
    """(count, 16) words: half any bits at all, half numbers as they stand in an estimate, each word for itself."""
    wild = rng.integers(0, 2**32, (count, ESTIMATE_WORDS), dtype=np.uint32)
    low = np.array([0, -5, 0, 0, -0.5, 0, -0.01, -0.01, 0, -0.01, 0, 0, 0, 0, 0, 0])
    high = np.array([1, 45, 9, 2, 0.5, 0.1, 0.01, 0.01, 0.03, 0.01, 1e-3, 2e7, 9, 12, 5, 30])
    usual = rng.uniform(low, high, wild.shape).astype(np.float32).view(np.uint32)
    return np.where(rng.random(wild.shape) < 0.5, wild, usual).astype(np.uint32)


def _empty(count: int) -> NDArray[np.void]:
    return np.zeros(count, SAMPLE)
