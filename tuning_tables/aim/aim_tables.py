"""The aim tables of one position, and the choice among them by weight category and by what is known of a cut."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

from tuning_tables.aim.aim_table import AimTable
from tuning_tables.errors import InvalidTable
from tuning_tables.requirement import require_kind, require_tuple


@dataclass(frozen=True)
class AimTables:
    """The `tables` of one position, numbered in their order from 0; ids differ.

    There is one table at most for a category and a kind of knowledge; a category has one name, and a name one number.
    Raises `InvalidTable`.

    Examples
    --------
    With `table` from the example of `AimTable`:

    >>> from tuning_tables.aim import AimTables
    >>> AimTables((table,)).select(3, measured=False).id
    'by-hand'
    """

    tables: tuple[AimTable, ...]

    def __post_init__(self) -> None:
        require_tuple(self.tables, "tables")
        if not self.tables:
            raise InvalidTable("a set of aim tables holds at least one.")
        for index, table in enumerate(self.tables):
            require_kind(table, f"tables[{index}]", AimTable)
        first, times = self.tables[0], Counter(table.id for table in self.tables)
        places: dict[tuple[int, bool], str] = {}
        names: dict[int, str] = {}
        for table in self.tables:
            number, name = table.category.number, table.category.name
            if table.position != first.position:
                raise InvalidTable(
                    f"{table.id} is for the position {table.position.name}, {first.id} for {first.position.name}, or "
                    "they end elsewhere, but a set serves one position: export them apart."
                )
            if times[table.id] > 1:
                raise InvalidTable(f"the id {table.id} is given to {times[table.id]} aim tables.")
            if names.setdefault(number, name) != name:
                raise InvalidTable(f"the category number {number} stands for {names[number]} and for {name}.")
            other = places.setdefault((number, table.is_measured), table.id)
            if other != table.id:
                known = "its measured resistance" if table.is_measured else "it alone"
                raise InvalidTable(f"{other} and {table.id} are both for the category {name} by {known}: give one.")
        if len(set(names.values())) < len(names):
            raise InvalidTable(f"two of the category numbers {sorted(names)} stand for one name.")

    def __repr__(self) -> str:
        return f"AimTables({len(self.tables)} tables of {self.tables[0].position.name})"

    def select(self, category: int, measured: bool) -> AimTable | None:
        """The table for cuts of a category.

        Parameters
        ----------
        category
            Number of the weight category.
        measured
            Whether the resistance of the cut was measured.

        Returns
        -------
        AimTable or None
            None where there is no such table.
        """
        found = (each for each in self.tables if (each.category.number, each.is_measured) == (category, measured))
        return next(found, None)

    def exported_numbers(self) -> Mapping[str, int]:
        """The categories of the set and their numbers."""
        return {table.category.name: table.category.number for table in self.tables}
