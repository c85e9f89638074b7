"""Golden choices of a book: commands where a wrong implementation of the choice shows, with the right answers."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tuning_tables.active_table import ActiveTable
from tuning_tables.category_number import KNOWN_NUMBERS, LARGEST_OWN
from tuning_tables.table_book import Status, TableBook


@dataclass(frozen=True)
class GoldenChoice:
    """A command, and how the choice ends: status, the chosen lines and the tables that they come from.

    `category`: the number of the weight category.
    """

    category: int
    axles: int
    commanded_m_s: np.float32
    status: Status
    table: ActiveTable | None
    numbers: tuple[int, ...]


def golden_choices(book: TableBook) -> tuple[GoldenChoice, ...]:
    """Commands at, next to, between and beyond the targets of every class; no numbers; classes that the book lacks."""
    found = [
        golden_choice(book, category, axles, speed)
        for category, axles in book.by_class
        for speed in _commands(book, category, axles)
    ]
    category, axles = next(iter(book.by_class))
    most = max(axles for _, axles in book.by_class)
    found.append(golden_choice(book, category, most + 1, np.float32(book.tables[0].target_speed_m_s)))
    target = np.float32(book.tables[0].target_speed_m_s)
    lacking = sorted({0, 6, LARGEST_OWN, *KNOWN_NUMBERS.values()} - {*book.category_numbers.values()})
    found += [GoldenChoice(number, axles, target, Status.NO_CLASS, None, ()) for number in lacking]
    return tuple(found)


def golden_choice(book: TableBook, category: str, axles: int, commanded_m_s: np.float32) -> GoldenChoice:
    """What `book.choose` answers to one command."""
    choice = book.choose(category, axles, float(commanded_m_s))
    number = book.number_of(category)
    return GoldenChoice(number, axles, commanded_m_s, choice.status, choice.table, choice.numbers)


def _commands(book: TableBook, category: str, axles: int) -> list[np.float32]:
    """Commanded speeds around the targets of one class."""
    targets = [np.float32(book.tables[number].target_speed_m_s) for number in book.candidates(category, axles)]
    commands = [np.float32(value) for value in (np.nan, np.inf, -np.inf, -1.0, -0.0, 0.0)]
    for target in targets:
        commands += [np.nextafter(target, np.float32(0.0)), target, np.nextafter(target, np.float32(np.inf))]
    for slower, faster in pairwise(targets):
        commands += [slower + (faster - slower) * np.float32(part) for part in (0.1, 0.5, 0.7)]
    return [*commands, targets[-1] + np.float32(1.0), np.finfo(np.float32).max]
