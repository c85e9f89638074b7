"""The tables of a book by what is alike: every name of a weight category has one number; which may regulate a cut,
by category and number of axles; and which differ in nothing but target and lines, so that there is something
between.

Which tables of a book are of one family: they differ in nothing but target and lines, so there is something between. A
controller holds the number of its family with each table, so it need not compare tables to know.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Final, Protocol, TypeVar

import numpy as np

from tuning_tables.active_table import interpolable
from tuning_tables.category_number import LARGEST_OWN, LEAST_OWN
from tuning_tables.errors import InvalidTable, require_kind, require_tuple
from tuning_tables.provenance import CutId, RetarderId
from tuning_tables.stage import LARGEST_FLOAT32
from tuning_tables.table import ControllerTable


class OfClass(Protocol):
    """A table of either kind: it has a name and is for a class of cuts."""

    @property
    def id(self) -> str:
        """Name of the table."""
        ...

    @property
    def cut(self) -> CutId:
        """The class of cuts."""
        ...


def exported_number(table: OfClass) -> int:
    """What stands for the table's category in C and Structured Text; `InvalidTable` for one without number."""
    if table.cut.number is None:
        raise InvalidTable(
            f"{table.id} is for the category {table.cut.category}, which has no number, but controller code chooses by "
            f"number: give the table a cut.category_number in [{LEAST_OWN}, {LARGEST_OWN}] (CutId of tuning_tables), "
            "then export it."
        )
    return table.cut.number


def category_numbers(tables: Sequence[OfClass]) -> Mapping[str, int | None]:
    """The number of every category, None for one without, in order of first appearance.

    Raises `InvalidTable` where a category has two numbers, or a number two categories.
    """
    of_name: dict[str, tuple[str, int | None]] = {}
    of_number: dict[int, tuple[str, str]] = {}
    for table in tables:
        name, number = table.cut.category, table.cut.number
        first, known = of_name.setdefault(name, (table.id, number))
        if known != number:
            raise InvalidTable(
                f"the category {name} has the number {known} in {first}, but {number} in {table.id}; in one book it "
                "must have one: give both tables the same cut.category_number."
            )
        if number is not None:
            first, other = of_number.setdefault(number, (table.id, name))
            if other != name:
                raise InvalidTable(
                    f"the number {number} stands for the category {other} in {first}, but for {name} in {table.id}; "
                    "in one book it must stand for one: give one of them another cut.category_number."
                )
    return MappingProxyType({name: number for name, (_, number) in of_name.items()})


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


def families_of(tables: Sequence[ControllerTable]) -> tuple[int, ...]:
    """Of each table its family: the number of the first table, from 0, that is for the same cut and `interpolable`."""
    found: list[int] = []
    for number, table in enumerate(tables):
        first = (each for each in dict.fromkeys(found) if is_family(tables[each], table))
        found.append(next(first, number))
    return tuple(found)


def is_family(one: ControllerTable, other: ControllerTable) -> bool:
    """Whether the two are for the same cut, as a controller knows it, and what lies between has a meaning."""
    return for_cut(one) == for_cut(other) and interpolable(one, other)


def for_cut(table: ControllerTable) -> tuple[str, int, np.float32]:
    """What a controller knows of the cut of a table: category, axles, mass in t."""
    return table.cut.category, len(table.cut.axle_offsets_m), np.float32(table.cut.mass_t)
