"""The tables for point sensors of one retarder position, and the choice of the one to regulate a cut with.

The choice is that of `tuning_tables.table_book`, but for lines between two tables: between two targets, as above the
highest, it is the table of the next target below the commanded speed. So no choice aims at more than was commanded.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tuning_tables.book_categories import category_numbers
from tuning_tables.cut_classes import candidates_by_class, exported_number, require_one_position
from tuning_tables.errors import InvalidTable
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.requirement import require_kind, require_tuple
from tuning_tables.table_book import Status


@dataclass(frozen=True)
class PassageChoice:
    """`status` (TUNED, SLOWER, NO_CLASS or NO_TARGET), and the number of the table in the book, None for no table."""

    status: Status
    number: int | None


@dataclass(frozen=True)
class PassageBook:
    """The tables of one position with its sensors, numbered in their order from 0; ids differ.

    A category has one number and a number one category. Raises `InvalidTable`.
    """

    tables: tuple[PassageTable, ...]

    def __post_init__(self) -> None:
        require_tuple(self.tables, "tables")
        if not self.tables:
            raise InvalidTable("a book holds at least one table.")
        for index, table in enumerate(self.tables):
            require_kind(table, f"tables[{index}]", PassageTable)
        require_one_position(self.tables)
        first = self.tables[0]
        for table in self.tables:
            if (table.sensors.path_m, table.sensors.base_m) != (first.sensors.path_m, first.sensors.base_m):
                raise InvalidTable(
                    f"{table.id} is for other sensors than {first.id}: their sensors.path_m or base_m differ, but a "
                    "book serves one position: export them apart."
                )
        category_numbers(self.tables)

    @cached_property
    def category_numbers(self) -> Mapping[str, int | None]:
        """The number of every weight category, None for one without, in order of first appearance."""
        return category_numbers(self.tables)

    def exported_numbers(self) -> Mapping[str, int]:
        """What stands for every category in C and Structured Text; `InvalidTable` for one without number."""
        return {table.cut.category: exported_number(table) for table in self.tables}

    @cached_property
    def by_class(self) -> Mapping[tuple[str, int], tuple[int, ...]]:
        """Numbers of the tables that every class (category, axles) chooses from, by rising target."""
        return candidates_by_class(self.tables)

    def shadowed(self) -> tuple[PassageTable, ...]:
        """The tables that no choice can use: another of the same category and axles is heavier, or comes first."""
        used = {number for numbers in self.by_class.values() for number in numbers}
        return tuple(table for number, table in enumerate(self.tables) if number not in used)

    def choose(self, category: str, axles: int, commanded_m_s: float) -> PassageChoice:
        """The table for a cut of `category` on `axles` axles that shall leave with `commanded_m_s`."""
        numbers = self.by_class.get((category, axles), ())
        if not numbers:
            return PassageChoice(Status.NO_CLASS, None)
        with np.errstate(over="ignore"):
            target = np.float32(commanded_m_s)
        targets = [np.float32(self.tables[number].target_speed_m_s) for number in numbers]
        if not (np.isfinite(target) and target >= targets[0]):
            return PassageChoice(Status.NO_TARGET, None)
        place = max(index for index, tuned in enumerate(targets) if tuned <= target)
        status = Status.TUNED if targets[place] == target else Status.SLOWER
        return PassageChoice(status, numbers[place])
