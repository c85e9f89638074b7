"""Which tables of a book share an estimator: cuts of one class, whatever their target, do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from tuning_tables.estimator import Estimator
from tuning_tables.table_book import TableBook

NONE: Final = -1
"""Number of the estimator of a table that has none."""


@dataclass(frozen=True)
class DistinctEstimators:
    """The estimators of a book, each once, in order of first appearance; `of_table[n]` is its number, `NONE` for none.

    Two tables have one number exactly where `active_table.same_estimator` holds.
    """

    estimators: tuple[Estimator, ...]
    of_table: tuple[int, ...]

    @property
    def first_tables(self) -> tuple[int, ...]:
        """For each estimator the first table that has it; last, if there is one, the first table without any."""
        numbers = [*range(len(self.estimators)), *([NONE] if NONE in self.of_table else [])]
        return tuple(self.of_table.index(number) for number in numbers)


def distinct_estimators(book: TableBook) -> DistinctEstimators:
    """The estimators of `book`."""
    found: dict[bytes, int] = {}
    estimators: list[Estimator] = []
    of_table = []
    for table in book.tables:
        estimator = table.estimator
        if estimator is None:
            of_table.append(NONE)
            continue
        key = _numbers(estimator)
        if key not in found:
            found[key] = len(estimators)
            estimators.append(estimator)
        of_table.append(found[key])
    return DistinctEstimators(tuple(estimators), tuple(of_table))


def _numbers(estimator: Estimator) -> bytes:
    """All that a controller holds of it; 0.0 for -0.0, which compare alike."""
    touch_kpa = np.array([estimator.touch_pressure_kpa], dtype=np.float32)
    numbers = np.concatenate([np.array([*estimator.numbers.values()], np.float32), touch_kpa, estimator.work.ravel()])
    return (numbers + np.float32(0.0)).tobytes()
