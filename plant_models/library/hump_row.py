"""A row of the table `[hump]`."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models.hump import GROUPS
from plant_models.library.hump_cells import Cell, Cells
from plant_models.library.hump_elements import given, is_faulty
from plant_models.library.toml_lines import Place


@dataclass(frozen=True)
class Row:
    """A row by its `kind` (switch, signal, …), with its cells and its place in the file."""

    kind: str
    cells: Cells
    place: Place

    @property
    def number(self) -> int | None:
        """Of its element, if it has one."""
        number: int | None = given(self.cells, "number", None)
        return number

    @property
    def is_numbered(self) -> bool:
        """It has a number of its group."""
        return self.number is not None and any(self.number in group for group in GROUPS if group.noun == self.kind)

    @property
    def leads_on(self) -> bool:
        """Where its edges lead is told."""
        leads_on = [isinstance(edge.get("to"), Cell) and not is_faulty(edge, "to") for edge in self.edges]
        ends = self.kind == "section" and not any("to" in edge for edge in self.edges)
        return ends or (all(leads_on) and len(leads_on) == (2 if self.kind == "switch" else 1))

    @property
    def edges(self) -> tuple[Cells, ...]:
        """The tables of its edges, as far as they are there."""
        found = (self.cells.get(key) for key in ("next", "left", "right"))
        return tuple(each for each in found if isinstance(each, dict))
