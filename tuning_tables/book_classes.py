"""What the tables of a book have in common, and which a cut may be regulated by: its category and number of axles."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Final, Protocol, TypeVar

import numpy as np

from tuning_tables.book_categories import OfClass, category_numbers
from tuning_tables.errors import InvalidTable
from tuning_tables.line_order import LARGEST_FLOAT32
from tuning_tables.provenance import RetarderId
from tuning_tables.requirement import require_kind, require_tuple

LEAST_FLOAT32: Final = float(np.finfo(np.float32).smallest_normal)


class ForTarget(OfClass, Protocol):
    """A table of either kind, for a class of cuts and an exit speed."""

    @property
    def target_speed_m_s(self) -> float:
        """Exit speed that it aims at."""
        ...

    @property
    def retarder(self) -> RetarderId:
        """The position that it is for."""
        ...


_Table = TypeVar("_Table", bound=ForTarget)


def require_book(
    tables: tuple[_Table, ...], kind: type[_Table], position_of: Callable[[_Table], object], parts: str
) -> None:
    """`tables` is a tuple of at least one of `kind`; raises `InvalidTable`.

    All are of one position, of which `parts` are what `position_of` holds besides the retarder; ids differ; float32
    holds masses and targets; a category has one number and a number one category.
    """
    require_tuple(tables, "tables")
    if not tables:
        raise InvalidTable("a book holds at least one table.")
    for index, table in enumerate(tables):
        require_kind(table, f"tables[{index}]", kind)
    first, times = tables[0], Counter(table.id for table in tables)
    for table in tables:
        if position_of(table) != position_of(first):
            raise InvalidTable(
                f"{table.id} is for the retarder {table.retarder.name}, {first.id} for {first.retarder.name}, "
                f"or their {parts} differ, but a book serves one position: export them apart."
            )
        if times[table.id] > 1:
            raise InvalidTable(f"the id {table.id} is given to {times[table.id]} tables of the book.")
        for key, value in (("cut.mass_t", table.cut.mass_t), ("target_speed_m_s", table.target_speed_m_s)):
            if not LEAST_FLOAT32 <= value <= LARGEST_FLOAT32:
                raise InvalidTable(f"{key} of {table.id} is {value!r}, which float32 cannot hold.")
    category_numbers(tables)


def tables_by_class(tables: Sequence[ForTarget]) -> Mapping[tuple[str, int], tuple[int, ...]]:
    """Of every class (category, axles) the numbers of its tables by rising target, one a target; first classes first.

    If several masses answer to a class, those of the largest mass: they begin to brake first. Speeds and masses are
    compared as float32 numbers; of equal tables the first counts.
    """
    members: dict[tuple[str, int], list[int]] = {}
    for number, table in enumerate(tables):
        members.setdefault((table.cut.category, len(table.cut.axle_offsets_m)), []).append(number)
    return MappingProxyType({each: _heaviest_by_target(tables, numbers) for each, numbers in members.items()})


def _heaviest_by_target(tables: Sequence[ForTarget], numbers: Sequence[int]) -> tuple[int, ...]:
    heaviest = max(np.float32(tables[number].cut.mass_t) for number in numbers)
    by_target: dict[float, int] = {}
    for number in numbers:
        if np.float32(tables[number].cut.mass_t) == heaviest:
            by_target.setdefault(float(np.float32(tables[number].target_speed_m_s)), number)
    return tuple(by_target[target] for target in sorted(by_target))
