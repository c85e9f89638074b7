"""The weight categories of a book: every name with one number, every number with one name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Protocol

from tuning_tables.category_number import LARGEST_OWN, LEAST_OWN
from tuning_tables.errors import InvalidTable
from tuning_tables.provenance import CutId


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
