"""Golden rows for point sensors: readings at passages where a wrong rule shows, commands where a wrong choice
shows, with the right answers, and how much of them a self-test holds.

Golden stages of a table: readings at passages where a wrong implementation of the rule shows, with the right stages.
Their speeds lie on, next to (one float32 step) and beyond the switching speeds of every passage and stage in force.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from tuning_tables.book_classes import exported_number
from tuning_tables.category_number import KNOWN_NUMBERS, LARGEST_OWN
from tuning_tables.golden_vectors import LARGEST, LEAST_NORMAL, SMALLEST, STAGE_LIMITS
from tuning_tables.passages.golden_pulses import few_golden_pairs, few_golden_pulses, golden_pairs, golden_pulses
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.rule import held_by
from tuning_tables.programs.at_pulse import wanted_stage
from tuning_tables.table_book import Status

Reading: TypeAlias = tuple[int, int, float]
"""Passage, stage in force, speed in m/s."""

STAGE_ROW: Final = np.dtype([("passage", "i4"), ("stage", "i4"), ("reading_m_s", "f4"), ("wanted", "i4")])
"""What `wanted_stage` is asked, by its parameters, and its answer."""

MOST_ROWS: Final = 4000
"""Readings beside switching speeds; of a table with more of these, speeds evenly spread over it are taken."""

FEW_ROWS: Final = 240


def golden_stages(table: PassageTable) -> npt.NDArray[np.void]:
    """Rows of `STAGE_ROW`: up to `MOST_ROWS` beside switching speeds, and what cannot be. Equal tables, equal rows."""
    return answered(table, [*_beside_speeds(table, MOST_ROWS), *_odd_readings(table, len(table.passages))])


def few_golden_stages(table: PassageTable) -> npt.NDArray[np.void]:
    """The same for a small controller: up to `FEW_ROWS` beside switching speeds, odd readings at one passage."""
    return answered(table, [*_beside_speeds(table, FEW_ROWS), *_odd_readings(table, 1)])


def answered(table: PassageTable, readings: list[Reading]) -> npt.NDArray[np.void]:
    """The readings with the stages that the rule wants."""
    held, rows = held_by(table), np.zeros(len(readings), dtype=STAGE_ROW)
    for row, (passage, stage, v_m_s) in zip(rows, readings, strict=True):
        row["passage"], row["stage"], row["reading_m_s"] = passage, stage, v_m_s
        row["wanted"] = wanted_stage(held, passage, stage, row["reading_m_s"])
    return rows


def _beside_speeds(table: PassageTable, most: int) -> Iterator[Reading]:
    """Every finite switching speed and its two neighbours, or as many of them as may be."""
    places = np.argwhere(np.isfinite(table.switching_m_s))
    every = max(1, -(-3 * len(places) // most))
    for passage, stage, threshold in places[::every].tolist():
        speed = table.switching_m_s[passage, stage, threshold]
        with np.errstate(over="ignore"):  # beyond the largest number is infinity, and held at
            beside = (np.nextafter(speed, np.float32(-np.inf)), speed, np.nextafter(speed, np.float32(np.inf)))
        yield from ((passage, stage, float(v)) for v in beside)


def _odd_readings(table: PassageTable, passages: int) -> Iterator[Reading]:
    """What cannot be true, or only just can, at some passages in every stage; no such passage, no such stage."""
    count, stages = len(table.passages), len(table.pressure_kpa)
    speeds = (np.nan, np.inf, -np.inf, -1.0, -SMALLEST, -0.0, 0.0, SMALLEST, LEAST_NORMAL, LARGEST, -LARGEST)
    for passage in np.unique(np.linspace(0, count - 1, min(passages, 4)).astype(int)).tolist():
        yield from ((passage, stage, v) for stage in range(stages) for v in speeds)
    for stage in (-1, stages, *STAGE_LIMITS):
        yield from ((0, stage, v) for v in (0.0, 100.0))
    for passage in (-1, count, *STAGE_LIMITS):
        yield from ((passage, stages // 2, v) for v in (0.0, 100.0))
    for passage in {max(table.before_entrance - 1, 0), min(table.before_entrance, count - 1)}:
        yield from ((passage, stage, v) for stage in range(stages) for v in (0.0, 100.0))


@dataclass(frozen=True, eq=False)
class GoldenPassages:
    """Rows of `STAGE_ROW`, `PAIR_ROW` and `PULSE_ROW` of one table (see `golden_stages`, `golden_pulses`)."""

    stages: npt.NDArray[np.void]
    pairs: npt.NDArray[np.void]
    pulses: npt.NDArray[np.void]

    def __post_init__(self) -> None:
        for array in vars(self).values():
            array.setflags(write=False)


def golden_passages(table: PassageTable) -> GoldenPassages:
    """All that may show a fault."""
    return GoldenPassages(golden_stages(table), golden_pairs(table), golden_pulses(table))


def few_golden_passages(table: PassageTable) -> GoldenPassages:
    """What a small controller holds."""
    return GoldenPassages(few_golden_stages(table), few_golden_pairs(table), few_golden_pulses(table))


@dataclass(frozen=True)
class GoldenSelection:
    """A command, and how the choice ends: status, and the number of the table, None for none."""

    category: int
    axles: int
    commanded_m_s: np.float32
    status: Status
    table: int | None


def golden_selections(book: PassageBook) -> tuple[GoldenSelection, ...]:
    """Commands at, next to, between and beyond the targets of every class; no numbers; classes that the book lacks."""
    found = []
    for (category, axles), numbers in book.by_class.items():
        targets = [np.float32(book.tables[number].target_speed_m_s) for number in numbers]
        commands = [np.float32(value) for value in (np.nan, np.inf, -np.inf, -1.0, -0.0, 0.0)]
        for target in targets:
            commands += [np.nextafter(target, np.float32(0.0)), target, np.nextafter(target, np.float32(np.inf))]
        commands += [slower + (faster - slower) * np.float32(0.5) for slower, faster in pairwise(targets)]
        commands += [targets[-1] + np.float32(1.0), np.finfo(np.float32).max]
        found += [_answered(book, category, axles, command) for command in commands]
    category, axles = next(iter(book.by_class))
    target = np.float32(book.tables[0].target_speed_m_s)
    found.append(_answered(book, category, max(axles for _, axles in book.by_class) + 1, target))
    lacking = sorted({0, 6, LARGEST_OWN, *KNOWN_NUMBERS.values()} - {table.cut.number for table in book.tables})
    found += [GoldenSelection(number, axles, target, Status.NO_CLASS, None) for number in lacking]
    return tuple(found)


def _answered(book: PassageBook, category: str, axles: int, commanded_m_s: np.float32) -> GoldenSelection:
    choice = book.choose(category, axles, float(commanded_m_s))
    category_number = next(exported_number(table) for table in book.tables if table.cut.category == category)
    return GoldenSelection(category_number, axles, commanded_m_s, choice.status, choice.number)
