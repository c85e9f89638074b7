"""Golden selections of a book for point sensors: commands where a wrong choice shows, with the right answers."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tuning_tables.book_categories import exported_number
from tuning_tables.category_number import KNOWN_NUMBERS, LARGEST_OWN
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.table_book import Status


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
