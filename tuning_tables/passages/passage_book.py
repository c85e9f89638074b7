"""The tables for point sensors of one position, and the choice of the one to regulate a cut with.

The choice is that of `tuning_tables.table_book`, but for its rule 5: between two targets there are no switching speeds
in between, and the table of the lower target is taken. So no choice aims at more than the commanded speed. Switching
speeds depend on the target, and at the infinite ones there is nothing to interpolate: who needs more exit speeds tunes
more tables.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tuning_tables.book_classes import require_book, tables_by_class
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.table_book import Status


@dataclass(frozen=True)
class PassageChoice:
    """The chosen `table` and its `number` in the book, both None where `status` is below 0.

    Examples
    --------
    With `table` from the example of `PassageTable`:

    >>> from tuning_tables import PassageBook
    >>> choice = PassageBook((table,)).choose("Т", axles=2, commanded_m_s=3.0)
    >>> choice
    PassageChoice(status=<Status.NO_CLASS: -1>, table=None, number=None)
    """

    status: Status
    table: PassageTable | None
    number: int | None


@dataclass(frozen=True)
class PassageBook:
    """The `tables` of one position, numbered in their order from 0.

    Ids differ. Retarder position and sensors are the same in all: a controller is wired to one set of sensors, whatever
    the cut. A category has one number and a number one category. Raises `InvalidTable`.

    Examples
    --------
    With `table` from the example of `PassageTable`:

    >>> from tuning_tables import PassageBook
    >>> PassageBook((table,)).choose("С", axles=2, commanded_m_s=3.0).number
    0
    """

    tables: tuple[PassageTable, ...]

    def __post_init__(self) -> None:
        require_book(self.tables, PassageTable, position_of, "zones, dead bands or sensors")

    def __repr__(self) -> str:
        return f"PassageBook({len(self.tables)} tables of {self.tables[0].retarder.name})"

    def __reduce__(self) -> tuple[type[PassageBook], tuple[tuple[PassageTable, ...]]]:
        """For pickle and copy: the tables; what follows from them is worked out anew."""
        return PassageBook, (self.tables,)

    @cached_property
    def by_class(self) -> Mapping[tuple[str, int], tuple[int, ...]]:
        """The candidates of every class (category, axles), by rising target."""
        return tables_by_class(self.tables)

    def shadowed(self) -> tuple[PassageTable, ...]:
        """The tables that no choice can use: another of the same category and axles is heavier, or comes first."""
        used = {number for numbers in self.by_class.values() for number in numbers}
        return tuple(table for number, table in enumerate(self.tables) if number not in used)

    def choose(self, category: str, axles: int, commanded_m_s: float) -> PassageChoice:
        """The table for a cut.

        Parameters
        ----------
        category
            Name of its weight category.
        axles
            Number of its axles.
        commanded_m_s
            The exit speed that is wanted, m/s.

        Returns
        -------
        PassageChoice
            The table that aims at no more than that, or none where no table may be taken.
        """
        numbers = self.by_class.get((category, axles), ())
        if not numbers:
            return PassageChoice(Status.NO_CLASS, None, None)
        with np.errstate(over="ignore"):
            target = np.float32(commanded_m_s)
        targets = [np.float32(self.tables[number].target_speed_m_s) for number in numbers]
        if not (np.isfinite(target) and target >= targets[0]):
            return PassageChoice(Status.NO_TARGET, None, None)
        place = max(index for index, tuned in enumerate(targets) if tuned <= target)
        status = Status.TUNED if targets[place] == target else Status.SLOWER
        return PassageChoice(status, self.tables[numbers[place]], numbers[place])


def position_of(table: PassageTable) -> tuple[object, ...]:
    """What makes the position that a table is for; where the pass ends depends on the length of the cut as well."""
    return (
        table.retarder.name,
        table.retarder.zones_m,
        table.retarder.dead_band_kpa,
        table.sensors,
    )
