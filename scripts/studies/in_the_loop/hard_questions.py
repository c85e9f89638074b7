"""Questions where a wrong implementation shows: readings and commands for the rule and the choice, and for the
estimator samples of cuts, readings that cannot be true, a faulty radar.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats
from scripts.studies.in_the_loop.controller_process import BEGIN, COMMAND, ESTIMATE_WORDS, GIVEN, ON, READING, SAMPLE
from tuning_tables import ControllerTable
from tuning_tables.estimator import Estimator
from tuning_tables.golden_choices import golden_choices
from tuning_tables.golden_tracks import LARGEST_OVERPRESSURE_KPA, LARGEST_SPEED_M_S, golden_tracks
from tuning_tables.golden_vectors import golden_vectors, line_speeds
from tuning_tables.rule import rises_at
from tuning_tables.table_book import TableBook


def hard_readings(book: TableBook, count: int, seed: int) -> NDArray[np.void]:
    """`count` readings, dtype READING: golden ones, ties and their neighbours, any bits, stages out of range."""
    rng = np.random.default_rng(seed)
    kinds = (golden_readings(book), near_lines(book, count // 2, rng), anything(book, count // 4, rng))
    found = np.concatenate(kinds)
    assert len(found) < count
    return np.concatenate([found, plausible(book, count - len(found), rng)])


def golden_readings(book: TableBook) -> NDArray[np.void]:
    """The vectors that are shipped."""
    parts = []
    for number, table in enumerate(book.tables):
        vectors = golden_vectors(table)
        of = np.full(len(vectors), number)
        parts.append(readings(of, vectors.stage, vectors.s_m, vectors.v_m_s, vectors.pressure_kpa))
    return np.concatenate(parts)


def near_lines(book: TableBook, count: int, rng: np.random.Generator) -> NDArray[np.void]:
    """Speeds on a line or surface, or up to two float32 steps from it; half of the lines are another stage's."""
    parts, lines = [], [
        (number, k, i) for number, t in enumerate(book.tables) for k, i in np.argwhere(t.has_line).tolist()
    ]  # fmt: skip
    each = count // len(lines)
    for number, k, i in lines:
        table = book.tables[number]
        low, high = (float(end) for end in table.valid_range[:2])
        s = rng.uniform(low - 1.0, high + 1.0, each).astype(np.float32)
        kpa = pressures(table, k, each, rng) if table.has_gauge else np.full(each, np.nan, np.float32)
        v = line_speeds(table.coefficients[k, i], np.clip(s, table.valid_range[0], table.valid_range[1]))
        if table.has_gauge:
            v = v + rises_at(table, k, kpa)[:, i]
        steps = rng.integers(-2, 3, each)
        for _ in range(2):
            towards = np.where(steps < 0, -np.inf, np.inf).astype(np.float32)
            v = np.where(steps != 0, np.nextafter(v, towards), v)
            steps -= np.sign(steps)
        stage = np.full(each, k)
        if table.farthest > 1:
            stage = np.where(rng.random(each) < 0.5, rng.integers(0, len(table.stages), each), stage)
        parts.append(readings(np.full(each, number), stage, s, v, kpa))
    return np.concatenate(parts)


def pressures(table: ControllerTable, stage: int, count: int, rng: np.random.Generator) -> NDArray[np.float32]:
    """Within the pressures of a table with slopes, and outside; some beside a bound, some that are none."""
    bounds = table.pressures[[0, table.highest_raised, stage]]
    found = rng.uniform(float(bounds[0]) - 60.0, float(table.pressures[-1]) + 60.0, count).astype(np.float32)
    edges = rng.choice(bounds, count)
    towards = rng.choice(np.array([-np.inf, np.inf], np.float32), count)
    beside = np.where(rng.random(count) < 0.5, np.nextafter(edges, towards), edges)
    found = np.where(rng.random(count) < 0.2, beside, found)
    return np.where(rng.random(count) < 0.1, rng.choice(NO_PRESSURES, count), found).astype(np.float32)


NO_PRESSURES = np.array([np.nan, np.inf, -np.inf, 3.4028235e38, -3.4028235e38, 1e-45, -0.0], dtype=np.float32)
"""What is no pressure, and what only just is one."""


def anything(book: TableBook, count: int, rng: np.random.Generator) -> NDArray[np.void]:
    """Any bits as path and speed: NaN of every kind, infinities, denormals; any stage."""
    bits = rng.integers(0, 2**32, (2, count), dtype=np.uint32)
    special = rng.integers(0, 4, (2, count))
    edged = bits & np.uint32(0x807FFFFF) | rng.choice(EXPONENTS, (2, count))
    bits = np.where(special == 0, edged, np.where(special == 1, edged & np.uint32(0xFF800000), bits)).astype(np.uint32)
    s, v = bits.view(np.float32)
    ordinary = rng.random(count) < 0.5
    s = np.where(ordinary, rng.uniform(-5.0, 45.0, count).astype(np.float32), s)
    s = np.where(rng.random(count) < 0.1, rng.choice(AT_THE_ENTRANCE, count), s)
    stage = np.where(rng.random(count) < 0.1, rng.integers(-(2**31), 2**31, count), rng.integers(-2, 11, count))
    number = rng.integers(0, len(book.tables), count)
    return readings(number, stage, s, v, any_pressures(book, count, rng))


def any_pressures(book: TableBook, count: int, rng: np.random.Generator) -> NDArray[np.float32]:
    """Any bits, half of them of usual pressures; NaN where no table of the book has slopes."""
    if not any(table.has_gauge for table in book.tables):
        return np.full(count, np.nan, np.float32)
    wild = rng.integers(0, 2**32, count, dtype=np.uint32).view(np.float32)
    usual = rng.uniform(-50.0, 1300.0, count).astype(np.float32)
    return np.where(rng.random(count) < 0.5, usual, wild).astype(np.float32)


EXPONENTS = np.array([0x00000000, 0x7F800000, 0x7F000000, 0x00800000], dtype=np.uint32)
"""Of denormals and zeros, of NaN and infinity, of the largest and of the smallest normal numbers."""


AT_THE_ENTRANCE = np.array([-1e-3, -1.1754944e-38, -1e-45, -0.0, 0.0, 1e-45, 1e-3], dtype=np.float32)
"""On either side of the place from which on any stage may be commanded."""


def plausible(book: TableBook, count: int, rng: np.random.Generator) -> NDArray[np.void]:
    """What a cut really gives, from before the approaches on."""
    begins = [float(table.valid_range[0]) for table in book.tables]
    s, v = rng.uniform(min(begins) - 1.0, 39.0, count), rng.uniform(0.0, 9.0, count)
    number, stage = rng.integers(0, len(book.tables), count), rng.integers(0, 5, count)
    return readings(number, stage, s, v, any_pressures(book, count, rng))


def readings(
    table: NDArray[Any], stage: NDArray[Any], s: NDArray[Any], v: NDArray[Any], pressure_kpa: NDArray[np.float32]
) -> NDArray[np.void]:
    """As an array of READING."""
    found = np.empty(len(table), READING)
    found["table"], found["stage"], found["s_m"], found["v_m_s"] = table, stage, s, v
    found["pressure_kpa"] = pressure_kpa
    return found


def hard_commands(book: TableBook, count: int, seed: int) -> NDArray[np.void]:
    """Commands for a choice, dtype COMMAND: the golden ones, and random ones with a third of them senseless."""
    rng = np.random.default_rng(seed)
    found = np.empty(count, COMMAND)
    numbers = [book.number_of(category) for category in book.category_numbers]
    found["category"] = rng.choice([*numbers, 0, -1, max(numbers) + 1], count)
    found["axles"] = rng.choice([4, 6, 8], count)
    targets = np.array([table.target_speed_m_s for table in book.tables], dtype=np.float32)
    speed = rng.uniform(1.0, 5.0, count).astype(np.float32)
    speed = np.where(rng.random(count) < 0.2, rng.choice(targets, count), speed)
    wild = rng.integers(0, 2**32, count, dtype=np.uint32).view(np.float32)
    found["speed_m_s"] = np.where(rng.random(count) < 0.3, wild, speed)
    golden = np.array([(c.category, c.axles, c.commanded_m_s) for c in golden_choices(book)], COMMAND)
    return np.concatenate([golden, found])


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
