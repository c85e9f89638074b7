"""Golden tracks: sequences of readings where a wrong implementation of the estimator shows, with the right estimates.

Every distinct estimator of a book has a few, of bounded length; and there is one for a table without any, where the
measured speed comes back as it is. Noise is of an integer generator, so that the same book gives the same bytes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.distinct_estimators import distinct_estimators
from tuning_tables.estimator import Estimator, begin, unseen_samples
from tuning_tables.golden_faults import (
    MISSING_M_S,
    Reading,
    faulty_radar,
    frozen_alone,
    hardest,
    leaping_after_three,
    rising_while_braked,
    wrong_at_first,
)
from tuning_tables.programs import observe
from tuning_tables.rule import alarms_for, speed_for
from tuning_tables.table import ControllerTable
from tuning_tables.table_book import TableBook

Floats = npt.NDArray[np.float32]

LARGEST_SPEED_M_S: Final = float(observe.LARGEST_SPEED_M_S)
LARGEST_OVERPRESSURE_KPA: Final = float(observe.LARGEST_OVERPRESSURE_KPA)
LARGEST_STEP_M: Final = float(observe.LARGEST_STEP_M)

LARGEST: Final = float(np.finfo(np.float32).max)
LEAST_NORMAL: Final = np.finfo(np.float32).smallest_normal
SMALLEST: Final = float(np.finfo(np.float32).smallest_subnormal)
CUT_SAMPLES: Final = 36
MOST_EDGES: Final = 4
STAGE_KPA: Final = (0.0, 0.0, 180.0, 390.0, 390.0, 240.0, 90.0, 0.0)
"""Overpressure in equal parts of a pass."""


@dataclass(frozen=True, eq=False)
class GoldenTrack:
    """n samples of one cut from its first on, for table `number`, and the estimates: all float32 (n,), m, m/s, kPa.

    `unseen`: samples since the last reading that was believed; `alarms`: the alarm word. `number` is that of the first
    table with this estimator.
    """

    number: int
    s_m: Floats
    v_m_s: Floats
    overpressure_kpa: Floats
    estimate_m_s: Floats
    unseen: Floats
    alarms: Floats

    def __post_init__(self) -> None:
        for array in self.samples:
            array.setflags(write=False)

    @property
    def samples(self) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
        """Path, speed, overpressure, estimate, samples since the last reading that was believed, alarms."""
        return self.s_m, self.v_m_s, self.overpressure_kpa, self.estimate_m_s, self.unseen, self.alarms

    def __len__(self) -> int:
        return len(self.s_m)


def golden_tracks(book: TableBook) -> tuple[GoldenTrack, ...]:
    """The tracks of every distinct estimator of the book, and of the first table without any."""
    numbers = distinct_estimators(book).first_tables
    return tuple(track for number in numbers for track in table_tracks(number, book.tables[number]))


def table_tracks(number: int, table: ControllerTable) -> tuple[GoldenTrack, ...]:
    """The tracks of `table`, number `number` in its book."""
    tracks = _unchanged() if table.estimator is None else _tracks(table.estimator)
    return tuple(_estimated(number, table, readings) for readings in tracks)


def _estimated(number: int, table: ControllerTable, readings: Iterable[Reading]) -> GoldenTrack:
    s, v, p = np.array(list(readings), dtype=np.float32).T
    state = begin()
    # Numbers that fit into the format may be absurd; what they give is infinite then, and no reason to warn.
    with np.errstate(all="ignore"):
        answers = [
            (speed_for(table, state, *map(float, reading)), unseen_samples(state), alarms_for(table, state))
            for reading in zip(s, v, p, strict=True)
        ]
    columns = np.array(answers, dtype=np.float32).T
    return GoldenTrack(number, *(column.copy() for column in (s, v, p, *columns)))


def _unchanged() -> Iterator[list[Reading]]:
    """Speeds that come back with every bit, those that have a portable literal apart; NaN is left out, of many bits."""
    _, fastest, too_fast = _beside(np.float32(LARGEST_SPEED_M_S))
    yield [(1.0, v, 0.0) for v in (MISSING_M_S, MISSING_M_S, 3.5, too_fast, MISSING_M_S, fastest, too_fast, 0.0)]
    yield [(1.0, v, 0.0) for v in (-0.0, -1.0, SMALLEST, LARGEST, np.inf, -np.inf)]


def _tracks(estimator: Estimator) -> Iterator[list[Reading]]:
    """Two cuts, the breaks, leaps, what cannot be true, faults of the radar, two cuts of another category, and what has
    no literal."""
    yield list(_cut(estimator, 1, 1.25, 6.0, 0.0))
    yield list(_cut(estimator, 2, 0.6, 4.0, 0.2))
    yield _at_breaks(estimator)
    yield _leaping(estimator)
    yield _begun_at_the_end(estimator)
    yield _incredible(estimator)
    yield list(faulty_radar(estimator))
    yield list(wrong_at_first(estimator))
    yield list(leaping_after_three(estimator))
    yield list(frozen_alone(estimator))
    yield list(rising_while_braked(estimator))
    yield list(_cut(estimator, 3, 2.6, 6.0, 0.0))
    yield list(_cut(estimator, 4, 0.2, 6.0, 0.0))
    yield _not_portable(estimator)


def _cut(estimator: Estimator, seed: int, factor: float, entry_m_s: float, share: float) -> Iterator[Reading]:
    """A cut with this friction, first seen at this share of the path; two readings of its speed are missing."""
    s_m, drive, brake = np.array(estimator.work, dtype=np.float64)
    noise, s, v = _noise(seed), float(s_m[0] + share * (s_m[-1] - s_m[0])), entry_m_s
    period_s = min(1.2 * (s_m[-1] - s_m[0]) / (CUT_SAMPLES * 0.75 * entry_m_s), 1.0)
    kpa = 0.0
    for sample in range(CUT_SAMPLES):
        measured = max(0.0, v + estimator.speed_noise_m_s * next(noise))
        yield s, MISSING_M_S if sample in (9, 10) else measured, kpa
        kpa = STAGE_KPA[sample * len(STAGE_KPA) // CUT_SAMPLES]
        ahead = s + v * period_s
        gained = float(np.interp(ahead, s_m, drive) - np.interp(s, s_m, drive))
        lost = factor * kpa * float(np.interp(ahead, s_m, brake) - np.interp(s, s_m, brake))
        # A cut that would stop creeps on, so that the track reaches the exit.
        s, v = ahead, min(max(v * v + 2.0 * (gained - lost), 1.0) ** 0.5, 15.0)


def _at_breaks(estimator: Estimator) -> list[Reading]:
    """Steps that end at a break, one float32 number before and behind it; some breaks where there are many.

    The cut is slow, so that the last bit of a work is not lost in its speed.
    """
    s_m = estimator.work[0]
    places = _telling_breaks(estimator)
    readings: list[Reading] = [(float(s_m[0]), 1.8, 0.0)]
    for count, place in enumerate(places):
        edge, speed = s_m[place], 1.8 - 0.1 * count
        below, _, above = _beside(edge)
        hard = LARGEST_OVERPRESSURE_KPA
        readings += [(below, speed, 150.0), (float(edge), speed, hard), (above, speed, hard)]
        # On by steps that are believed, to within reach of the next break.
        gap = float(s_m[places[min(count + 1, len(places) - 1)]]) - float(edge)
        steps = min(int(gap / LARGEST_STEP_M), 4)
        readings += [(float(edge) + gap * (i + 1) / (steps + 1.5), speed - 0.1, 100.0) for i in range(steps + 1)]
    return readings


def _telling_breaks(estimator: Estimator) -> list[int]:
    """Some breaks from first to last, and some where it matters which of the two lines that meet there is taken."""
    brake = estimator.work[2]
    differs = brake[:-1] + (brake[1:] - brake[:-1]) != brake[1:]
    inner = [index + 1 for index in np.flatnonzero(differs[:-1]).tolist()]
    return sorted({1, *_some([*range(len(brake))]), *_some(inner)})


def _some(places: list[int]) -> list[int]:
    """At most `MOST_EDGES` of `places`, first and last among them."""
    chosen = np.linspace(0, len(places) - 1, min(MOST_EDGES, len(places))).astype(np.int64)
    return [places[index] for index in chosen.tolist()]


def _beside(value: np.float32) -> tuple[float, float, float]:
    """`value` between its float32 neighbours; those of 0 are normal numbers, which have a portable literal."""
    if value == 0.0:
        return -float(LEAST_NORMAL), 0.0, float(LEAST_NORMAL)
    below, above = (float(np.nextafter(value, np.float32(end))) for end in (-np.inf, np.inf))
    return below, float(value), above


def _leaping(estimator: Estimator) -> list[Reading]:
    """Begun before the first break, which then counts; on by just too much, and by just not too much."""
    first, last = estimator.work[0, 0], estimator.work[0, -1]
    _, leap, beyond = _beside(first + np.float32(LARGEST_STEP_M))
    return [
        (float(first) - 1.0, 4.0, 200.0), (beyond, 4.2, 200.0), (leap, 4.1, 200.0), (float(first), 4.0, 200.0),
        (-LARGEST, 3.9, 200.0), (LARGEST, 3.8, 200.0), (leap + 0.9 * LARGEST_STEP_M, 2.5, 300.0),
        (leap + 1.8 * LARGEST_STEP_M, 2.4, 300.0), (float(last), 2.3, 0.0),
    ]  # fmt: skip


def _begun_at_the_end(estimator: Estimator) -> list[Reading]:
    """First seen at the last break: what is read from before it is no movement."""
    first, last = float(estimator.work[0, 0]), float(estimator.work[0, -1])
    inside = first + min(0.5 * (last - first), 0.5 * LARGEST_STEP_M)
    return [(last, 3.0, 0.0), (inside, 3.0, 400.0), (last, 3.0, 400.0), (last + 1.0, 3.0, 400.0)]


def _incredible(estimator: Estimator) -> list[Reading]:
    """Speeds and overpressures at, beside and beyond what is believed, where the brake works hardest."""
    first = float(estimator.work[0, 0])
    base, unit = hardest(estimator)
    _, speed, over_speed = _beside(np.float32(LARGEST_SPEED_M_S))
    _, pressure, over_pressure = _beside(np.float32(LARGEST_OVERPRESSURE_KPA))
    approach = [first + (base - first) * part / 4 for part in range(1, 5)]
    begins = [(first, v, 100.0) for v in (MISSING_M_S, over_speed, LARGEST, -LARGEST)]
    steps: list[Reading] = [
        (0.0, 4.6, 200.0), (-1.0, 4.4, 200.0), (0.0005, 4.2, 900.0), (0.5, 4.2, 200.0), (0.7, 4.2, -1.0),
        (0.8, over_speed, 200.0), (1.0, speed, 200.0), (1.3, speed, 600.0), (1.6, speed, 900.0), (1.9, speed, pressure),
        (2.2, 0.0, pressure), (2.5, 0.0, over_pressure), (2.8, 0.0, 900.0), (3.1, 0.0, 300.0), (3.4, 3.0, LARGEST),
        (3.7, MISSING_M_S, pressure), (4.0, LARGEST, 1500.0), (4.3, 30.0, 1500.0), (4.6, 0.0, 900.0), (4.9, 5.0, 400.0),
        (5.2, 5.0, over_pressure), (5.5, 5.0, pressure), (5.8, 6.0, 400.0), (6.1, 6.0, 400.0), (6.4, 5.0, 200.0),
    ]  # fmt: skip
    readings = [*begins, (first, 4.5, 0.0), *((s, 4.5, 200.0) for s in approach)]
    return readings + [(base + (step if step == 0.0005 else step * unit), v, kpa) for step, v, kpa in steps]


def _not_portable(estimator: Estimator) -> list[Reading]:
    """NaN, infinities, denormal numbers and -0.0 in the place of each reading, before and after the beginning."""
    first, last = float(estimator.work[0, 0]), float(estimator.work[0, -1])
    wild = (np.nan, np.inf, -np.inf, SMALLEST, -SMALLEST, -0.0)
    readings: list[Reading] = [(first, v, 0.0) for v in (np.nan, np.inf, -np.inf, -SMALLEST)]
    readings += [(np.nan, 3.5, np.nan)]
    steps = iter(np.linspace(first, min(last, first + 60.0), 4 * len(wild) + 2)[1:].tolist())
    for number in wild:
        readings += [
            (next(steps), number, 200.0), (next(steps), 3.4, number), (number, 3.3, 200.0), (next(steps), 3.2, 100.0)
        ]  # fmt: skip
    return readings


def _noise(seed: int) -> Iterator[float]:
    """Sums of four uniform numbers, of mean 0 and variance 1, from a linear congruential generator."""
    x = seed
    while True:
        total = 0
        for _ in range(4):
            x = (1664525 * x + 1013904223) % 2**32  # Numerical Recipes' constants
            total += x >> 16
        # Each of 65536 numbers has the variance (65536^2 - 1) / 12; of four, a third of 65536^2.
        yield (total - 2 * 65535) * 3**0.5 / 65536
