"""Cuts whose weight category was told wrongly, sample after sample, and which table brakes them, by Python."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tests.controller_code.sample_book import FOUR_AXLES, estimator_of, table_of
from tuning_tables import Estimator, alarms_for, begin, speed_for
from tuning_tables.programs.decide import table_after
from tuning_tables.table_book import TableBook

TARGET_M_S = 2.5
MASS_T = {1: 22.0, 2: 36.0, 4: 66.0, 5: 85.0}
"""By number of the category; the book lacks the third."""

NAMES = {1: "Л", 2: "ЛС", 4: "СТ", 5: "Т"}
SAMPLES = 80

Samples = npt.NDArray[np.float32]
"""Path, measured speed and overpressure, (samples, 3)."""


def weighed_book() -> TableBook:
    """A table of each category that there is, whose estimator knows how a brake works on its mass."""
    tables = (
        replace(table_of(NAMES[number], NAMES[number], mass_t, FOUR_AXLES, TARGET_M_S), estimator=weighed(mass_t))
        for number, mass_t in MASS_T.items()
    )
    return TableBook(tuple(tables))


def weighed(mass_t: float) -> Estimator:
    """The estimator of a cut of `mass_t`."""
    usual = estimator_of(16, 37.45)
    brake = tuple(40.0 / mass_t * each for each in usual.brake_m2_s2_per_kpa)
    return replace(usual, brake_m2_s2_per_kpa=brake)


def weighed_cuts(count: int) -> Iterator[tuple[int, Samples]]:
    """The category told, and the samples of a cut of any category, with readings that are missing and false."""
    chance = np.random.default_rng(20261125)
    for _ in range(count):
        told, number = chance.choice(list(MASS_T), 2)
        yield int(told), samples_of(weighed(MASS_T[int(number)]), chance)


def samples_of(cut: Estimator, chance: np.random.Generator) -> Samples:
    """One pass: the cut rolls, the pressure is that of now one stage, now another."""
    s_m, drive, brake = np.array(cut.work, dtype=np.float64)
    factor, s, v, kpa = chance.normal(1.0, 0.2), 0.0, chance.uniform(4.0, 6.0), 0.0
    found = np.empty((SAMPLES, 3), np.float32)
    for sample in range(SAMPLES):
        fault = chance.random()
        reading = v + 0.05 * chance.normal() + (4.0 if fault < 0.01 else 0.0)
        found[sample] = s, -1.0 if fault > 0.97 else reading, kpa
        kpa = chance.choice([0.0, 100.0, 250.0]) if sample % 8 == 0 else kpa
        ahead = s + 0.12 * v
        gained, lost = (np.interp(ahead, s_m, work) - np.interp(s, s_m, work) for work in (drive, brake))
        s, v = ahead, float(np.sqrt(max(v * v + 2.0 * (gained - factor * kpa * lost), 1.0)))
    return found


def braked_by(book: TableBook, told: int, samples: Samples) -> Iterator[tuple[int, float]]:
    """After every sample: the number of the category whose table is in force, and the speed to decide with."""
    numbers, states = list(MASS_T), [begin() for _ in book.tables]
    present = numbers.index(told)
    for sample in samples:
        readings = [float(each) for each in sample]
        speeds = [speed_for(table, state, *readings) for table, state in zip(book.tables, states, strict=True)]
        word = alarms_for(book.tables[present], states[present])
        present = table_after(word, present, len(numbers) - 1)
        yield numbers[present], speeds[present]
