"""The tables of one retarder position, and the choice of the one to regulate a cut with.

The choice knows what the yard knows of a cut: its weight category, its number of axles, the exit speed commanded.

1. Candidates are the tables of that category and number of axles. If several masses answer to both, those of the
   largest mass: they begin to brake first. None: no class of the book fits the cut.
2. No number, not above 0, or below the lowest target: no table, for every one would let the cut out too fast.
3. Equal to a target: that table.
4. Above the highest target: the table of the highest target. The cut leaves slower than asked.
5. Between two neighbouring targets: the lines between the two (`active_table.between`), or, where the two are not of
   one family (`book_families`), the table of the lower target.

So no choice aims at more than the commanded speed, and a cut that the book does not know is left to whoever commands.
Speeds and masses are compared as float32 numbers; of equal tables the first in the book counts.

How wrong the lines of rule 5 can be: on a way with the braking work A(s) per unit mass still to come, the speed from
which the cut just leaves with T is V = sqrt(T^2 + 2 A). It is convex in T, and linear interpolation over a step
h = T1 - T0 exceeds it by at most h^2/8 max d2V/dT2 <= h^2 / (12 sqrt(3) T0) = 0.048 h^2 / T0, nothing at the exit
(A = 0) and nothing at both targets: 0.024 m/s between 2 and 3 m/s, at places where V is about 1.7 T.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
from itertools import pairwise

import numpy as np

from tuning_tables.active_table import ActiveTable, active, between
from tuning_tables.book_classes import category_numbers, exported_number, families_of, require_book, tables_by_class
from tuning_tables.errors import InvalidTable
from tuning_tables.programs import choose
from tuning_tables.stage import NO_PRESSURE, UNIT_ROUNDOFF, Stage, range_above, reach_kpa, stage_gap, surface_bound
from tuning_tables.table import ControllerTable


class Status(IntEnum):
    """How a choice ended; below 0 there is no table."""

    TUNED = choose.TUNED
    BETWEEN = choose.BETWEEN
    SLOWER = choose.SLOWER
    NO_CLASS = choose.NO_CLASS
    NO_TARGET = choose.NO_TARGET


@dataclass(frozen=True)
class Choice:
    """The chosen lines, None where `status` is below 0, and the numbers of the tables in the book that they come from.

    `numbers` has one entry, two for lines between two tables (lower target first), none for no table.

    Examples
    --------
    With `table` from the example of `ControllerTable`:

    >>> from tuning_tables import TableBook
    >>> TableBook((table,)).choose("С", axles=4, commanded_m_s=3.0)
    Choice(status=<Status.TUNED: 0>, table=ActiveTable(to 3 m/s, 2 stages), numbers=(0,))
    """

    status: Status
    table: ActiveTable | None
    numbers: tuple[int, ...]


@dataclass(frozen=True)
class TableBook:
    """The `tables` of one position, numbered in their order from 0; ids differ, the position is the same in all.

    A category has one number and a number one category. Raises `InvalidTable`, also where float32 might let the lines
    between two neighbouring tables touch.

    Examples
    --------
    With `table` from the example of `ControllerTable`:

    >>> from tuning_tables import TableBook
    >>> book = TableBook((table,))
    >>> book
    TableBook(1 tables of my-retarder)
    >>> book.choose("С", axles=4, commanded_m_s=3.5).status
    <Status.SLOWER: 2>
    """

    tables: tuple[ControllerTable, ...]

    def __post_init__(self) -> None:
        require_book(self.tables, ControllerTable, position_of, "zones, dead bands or clocks")
        for slower, faster in self.neighbours():
            require_order_between(slower, faster)

    def __repr__(self) -> str:
        return f"TableBook({len(self.tables)} tables of {self.tables[0].retarder.name})"

    def __reduce__(self) -> tuple[type[TableBook], tuple[tuple[ControllerTable, ...]]]:
        """For pickle and copy: the tables; what follows from them is worked out anew."""
        return TableBook, (self.tables,)

    @cached_property
    def category_numbers(self) -> Mapping[str, int | None]:
        """The number of every weight category, None for one without, in order of first appearance."""
        return category_numbers(self.tables)

    def number_of(self, category: str) -> int:
        """What stands for a category of the book in C and Structured Text; `InvalidTable` for one without number."""
        return exported_number(next(table for table in self.tables if table.cut.category == category))

    def exported_numbers(self) -> Mapping[str, int]:
        """`number_of` every category of the book; raises as that."""
        return {category: self.number_of(category) for category in self.category_numbers}

    def shadowed(self) -> tuple[ControllerTable, ...]:
        """The tables that no choice can use: another of the same category and axles is heavier, or comes first."""
        used = {number for numbers in self.by_class.values() for number in numbers}
        return tuple(table for number, table in enumerate(self.tables) if number not in used)

    def candidates(self, category: str, axles: int) -> tuple[int, ...]:
        """Numbers of the tables that rule 1 leaves, by rising target, one a target."""
        return self.by_class.get((category, axles), ())

    @cached_property
    def by_class(self) -> Mapping[tuple[str, int], tuple[int, ...]]:
        """The candidates of every class (category, axles), classes in order of first appearance."""
        return tables_by_class(self.tables)

    @cached_property
    def families(self) -> tuple[int, ...]:
        """Of each table its family, the number of the first table that differs in nothing but target and lines."""
        return families_of(self.tables)

    def are_family(self, one: int, other: int) -> bool:
        """Whether there is something between the tables of these numbers."""
        return self.families[one] == self.families[other]

    @cached_property
    def has_pairs(self) -> bool:
        """Whether there is something between any two tables."""
        return len({*self.families}) < len(self.tables)

    def choose(self, category: str, axles: int, commanded_m_s: float) -> Choice:
        """The lines for a cut.

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
        Choice
            The lines that aim at no more than that, or none where no table may be taken.
        """
        numbers = self.candidates(category, axles)
        if not numbers:
            return Choice(Status.NO_CLASS, None, ())
        with np.errstate(over="ignore"):
            target = np.float32(commanded_m_s)
        targets = [np.float32(self.tables[number].target_speed_m_s) for number in numbers]
        if not (np.isfinite(target) and target >= targets[0]):
            return Choice(Status.NO_TARGET, None, ())
        place = max(index for index, tuned in enumerate(targets) if tuned <= target)
        slower = self.tables[numbers[place]]
        if targets[place] == target:
            return Choice(Status.TUNED, active(slower), (numbers[place],))
        if place + 1 == len(targets) or not self.are_family(*numbers[place : place + 2]):
            return Choice(Status.SLOWER, active(slower), (numbers[place],))
        faster = self.tables[numbers[place + 1]]
        return Choice(Status.BETWEEN, between(slower, faster, target), (numbers[place], numbers[place + 1]))

    def neighbours(self) -> Iterator[tuple[ControllerTable, ControllerTable]]:
        """All pairs of tables that lines may be taken between."""
        for numbers in self.by_class.values():
            for slower, faster in pairwise(numbers):
                if self.are_family(slower, faster):
                    yield self.tables[slower], self.tables[faster]


def position_of(table: ControllerTable) -> tuple[object, ...]:
    """What makes the retarder position of a table and its regulator; where the pass ends depends on the cut as well."""
    return table.retarder.name, table.retarder.zones_m, table.retarder.dead_band_kpa, table.clock


def require_order_between(slower: ControllerTable, faster: ControllerTable) -> None:
    """lower(s) < upper(s) holds for all lines between the two tables, however float32 rounds; raises `InvalidTable`.

    The exact gap between the lines is at least the smaller of the two tables' own; what rounding can take from it is at
    most 4 u (|c0| + |c1|) in a coefficient (three operations), and the evaluation of both lines.
    """
    path = (float(slower.valid_range[0]), float(slower.valid_range[1]))
    for one, other in zip(slower.stages, faster.stages, strict=True):
        if None in one.lines or None in other.lines:
            continue
        above = range_above(slower.pressures, slower.highest_raised, one.k) if slower.has_gauge else NO_PRESSURE
        gap_m_s = min(stage_gap(one, path, above), stage_gap(other, path, above))
        needed_m_s = _loss(one, other, path, above)
        if not gap_m_s > needed_m_s:
            raise InvalidTable(
                f"stages[{one.k}]: the lines between {slower.id} and {faster.id} come within {gap_m_s!r} m/s of each "
                f"other, but must stay {needed_m_s!r} apart; fit them further apart, or export the two apart."
            )


def _loss(one: Stage, other: Stage, path_m: tuple[float, float], above_kpa: tuple[float, float]) -> float:
    """What float32 can change in both lines between those of two stages, m/s."""
    reach_m, total = max(map(abs, path_m)), 0.0
    for lines, slopes in zip(
        zip(one.lines, other.lines, strict=True), zip(one.slopes, other.slopes, strict=True), strict=True
    ):
        size = tuple(abs(a) + abs(b) for a, b in zip(*(line or () for line in lines), strict=True))
        slope = sum(abs(each or 0.0) for each in slopes)
        coefficients = sum(value * reach_m**power for power, value in enumerate(size)) + slope * reach_kpa(above_kpa)
        total += 4 * UNIT_ROUNDOFF * coefficients + surface_bound(size, slope, path_m, above_kpa)
    return total
