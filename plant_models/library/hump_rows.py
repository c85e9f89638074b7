"""The rows of the table `[hump]`: their cells, where each begins from the crest, and the graph of their elements."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from plant_models.hump import GROUPS, HumpError, HumpGraph, Vertex
from plant_models.hump.edge import grade_faults
from plant_models.hump.ranges import LONGEST_EDGE_M
from plant_models.hump.structure import structure_faults
from plant_models.library.data_file import keyed, shown, shown_key
from plant_models.library.hump_cells import (
    ELEMENTS,
    PROFILE,
    Cell,
    Cells,
    Origin,
    TypeTables,
    checked_cell,
    checked_cells,
)
from plant_models.library.hump_elements import ElementMaker, given
from plant_models.library.hump_forms import wholes
from plant_models.library.hump_profile import with_grades
from plant_models.library.hump_row import Row
from plant_models.library.near_miss import near_miss
from plant_models.library.toml_lines import Place

KNOWN = ("leads", "profile_from_crest", *ELEMENTS)
"""Keys of the table `[hump]`."""


@dataclass(frozen=True)
class HumpRows:
    """The table `[hump]`: its `rows`, `leads`, and the cell of its profile, if it has one; with what `types` found."""

    rows: tuple[Row, ...]
    leads: tuple[int, ...] | None
    profile: Cell | None
    types: TypeTables

    @classmethod
    def read(cls, hump: Mapping[str, Any], types: TypeTables, origin: Origin) -> HumpRows:
        """Those of the table `hump`; what is at fault goes to what `types` has found."""
        found = types.found
        for key in hump:
            if key not in KNOWN:
                found.add(("hump", key), f"unknown key {shown_key(key)}; {near_miss(key[:40], KNOWN)}")
        leads = wholes(hump.get("leads"))
        if leads is None and not any(key not in KNOWN for key in hump):
            found.add(("hump", "leads"), "leads must be a list of whole numbers, the signal at each crest")
        profile = None
        if "profile_from_crest" in hump:
            place = ("hump", "profile_from_crest")
            profile = checked_cell(hump["profile_from_crest"], place[-1], PROFILE, place, origin, found)
            for sentence in grade_faults(profile.value, LONGEST_EDGE_M) if profile.value else ():
                found.add(place, keyed(sentence, {"grades: ": "profile_from_crest: "}))
        return cls(tuple(rows_in(hump, types, origin)), leads, profile, types)

    @property
    def cells(self) -> list[Cells]:
        """The cells of each row, and of the profile."""
        of_hump: Cells = {} if self.profile is None else {"profile_from_crest": self.profile}
        return [of_hump, *(row.cells for row in self.rows)]

    def graph(self) -> HumpGraph | None:
        """The graph of the elements; None where anything is at fault."""
        found = self.types.found
        rows = {row.number: row for row in reversed(self.rows) if row.number is not None}
        vertices: list[Vertex] = []
        for row, cells in zip(self.rows, self.cells_with_grades(), strict=True):
            first = rows.get(row.number) if row.number is not None else None
            if first is not None and first is not row:
                told = f"{first.place[1]}[{first.place[2]}] has the number {row.number}, too; numbers must be unique"
                found.add((*row.place, "number"), told)
            made = ElementMaker(row.kind, row.place, found).element(cells)
            if made is not None and (first is None or first is row):
                vertices.append(made)
        for error in self.faults_of_structure(vertices, rows):
            at = rows.get(error.element) if error.element is not None else None
            place: Place = ("hump", "leads") if at is None else at.place
            found.add(place, unnamed(error, str(place[1])))
        return HumpGraph(tuple(vertices), self.leads or ()) if not found else None

    def cells_with_grades(self) -> Iterator[Cells]:
        """The cells of each row, with the grades that follow from a profile of the hump."""
        if self.profile is None:
            return (row.cells for row in self.rows)
        return with_grades(self.rows, self.leads or (), self.profile, self.types.found)

    def faults_of_structure(self, vertices: Sequence[Vertex], rows: Mapping[int, Row]) -> Iterator[HumpError]:
        """What needs more than one row; `rows` by number."""
        made = {vertex.number for vertex in vertices}
        unmade = {
            number: [to for edge in row.edges if (to := given(edge, "to", None)) is not None]
            for number, row in rows.items()
            if number not in made
        }
        unnumbered = {
            row.kind
            for row in self.rows
            if not row.is_numbered or row.number is None or rows.get(row.number) is not row
        }
        groups = [group for group in GROUPS if group.noun in unnumbered]
        unsure = any(row.number not in made and not row.leads_on for row in self.rows)
        if self.leads is not None:
            yield from structure_faults(vertices, self.leads, unmade, groups, unsure)


def rows_in(hump: Mapping[str, Any], types: TypeTables, origin: Origin) -> Iterator[Row]:
    """Every row, kind by kind."""
    for kind, schema in ELEMENTS.items():
        listed = hump.get(kind, [])
        if not isinstance(listed, list):
            types.found.add(("hump", kind), f"{kind} is {shown(listed)}; it must be a list of tables")
            continue
        for row, raw in enumerate(listed):
            place: Place = ("hump", kind, row)
            with types.found.collecting():
                yield Row(kind, checked_cells(raw, schema, place, origin, types), place)


def unnamed(error: HumpError, kind: str) -> str:
    """The sentence of `error` without the element at its beginning, which the place tells."""
    named = f"{kind} {error.element}: "
    return str(error).removeprefix(named)
