"""The golden tracks beside the controller code: sequences of readings, each estimate worked out anew."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Final

from synth.checker.estimator import Estimator, Observer, next_unseen
from synth.checker.finding import DamagedError, shown
from synth.checker.float32 import bits, from_bits
from synth.checker.source_file import rows_below
from synth.checker.table_reading import Table

READINGS: Final = ("s_m", "v_m_s", "overpressure_kpa", "estimate_m_s")
WORDS: Final = tuple(f"{name}_bits" for name in READINGS)
TRACK_HEAD: Final = ["track", "table", "id", *WORDS, "unseen_samples", "alarms", *READINGS]

Sample = tuple[int, int, int, int, float, float]


def track_differences(content: bytes, tables: Sequence[Table], numbered: bool) -> Iterator[tuple[str, str]]:
    """(about, sentence) for each wrong track; `numbered`: whether `tables` have the order of the book."""
    rows = rows_below(TRACK_HEAD, content)
    if any(len(row) != len(TRACK_HEAD) for row in rows):
        raise DamagedError(f"one of its rows has not {len(TRACK_HEAD)} fields")
    numbers = {table.id: number for number, table in enumerate(tables)}
    tracked = set()
    for (track, number, name), group in groupby(rows, lambda row: (row[0], row[1], row[2])):
        samples = [sample_of(row) for row in group]
        if name not in numbers or (numbered and number != str(numbers[name])):
            yield "", f"track {shown(track)} is of table {shown(number)}, {shown(name)}, which is not there"
            continue
        table = tables[numbers[name]]
        if table.estimator is not None:
            tracked.add(table.estimator.held)
        at = first_fault(table.estimator, samples)
        if at is not None:
            yield table.id, f"the estimate at sample {at} of track {shown(track)} is another by its estimator"
    for table in tables:
        if table.estimator is not None and table.estimator.held not in tracked:
            yield table.id, "its estimator has no golden track"


def sample_of(row: Sequence[str]) -> Sample:
    """The words of one row, the samples since the last speed that was believed, and the alarms."""
    try:
        words = [int(cell, 16) for cell in row[3:7]]
        for word in words:
            from_bits(word)
        unseen, alarms = float(row[7]), float(row[8])
    except (ValueError, struct.error) as fault:
        raise DamagedError(f"{shown(row)} is no sample: {fault}") from None
    return words[0], words[1], words[2], words[3], unseen, alarms


def first_fault(estimator: Estimator | None, samples: Sequence[Sample]) -> int | None:
    """The first sample with another estimate, count or alarm.

    Without estimator the measured speed is due, bit for bit, and no alarm.
    """
    observer, unseen = Observer(estimator) if estimator is not None else None, 0.0
    for at, (s, v, kpa, estimate, counted, alarmed) in enumerate(samples):
        right = v if observer is None else bits(observer.observe(from_bits(s), from_bits(v), from_bits(kpa)))
        unseen = next_unseen(unseen, from_bits(v)) if observer is None else observer.unseen
        if counted != unseen or alarmed != (0 if observer is None else observer.alarms):
            return at
        both = math.isnan(from_bits(right)) and math.isnan(from_bits(estimate))  # of absurd work; there are many NaN
        if right != estimate and not both:
            return at
    return None
