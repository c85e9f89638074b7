"""The rows of the table `[hump]`: their cells, where each begins from the crest, the grades that follow from the
profile, and the graph of their elements.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from plant_models.errors import near_miss
from plant_models.hump import GROUPS, HumpError, HumpGraph, Vertex
from plant_models.hump.edge import SHORTEST_GRADE_M, Grades, grade_faults
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
from plant_models.library.hump_elements import ElementMaker, given, is_faulty
from plant_models.library.hump_forms import FoundFaults, wholes
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


GRADE: Final = "grade_permille"

DIGITS: Final = 6
"""Of metres: grades of edges keep no noise of sums."""


def with_grades(rows: Sequence[Row], leads: Sequence[int], profile: Cell, found: FoundFaults) -> Iterator[Cells]:
    """The cells of each row with the grades that `profile` gives to its edges.

    What is at fault goes to `found`: grades of an edge beside the profile, and an element that does not lie as far from
    one of the crests `leads` as from another.
    """
    places = places_from_crest(rows, leads, found)
    for row in rows:
        cells = dict(row.cells)
        for key in ("next", "left", "right"):
            edge = cells.get(key)
            if not isinstance(edge, dict):
                continue
            own = edge.get(GRADE)
            if isinstance(own, Cell):
                found.add(
                    own.place, f"{GRADE} is given, and profile_from_crest of the hump, too; take one of the two out"
                )
            at = places.get(row.number) if row.number is not None else None
            grades = grades_of(profile, at, given(edge, "length_m", None))
            cells[key] = {**edge, GRADE: Cell(grades, profile.place, "", Origin())}
        yield cells


def grades_of(profile: Cell, at_m: float | None, length_m: float | None) -> Grades | None:
    """Of an edge that begins `at_m` from the crest: None where the profile is at fault; level where its place is not
    known, which is a fault of its own."""
    if not profile.value:
        return None
    return ((0.0, 0.0),) if at_m is None or length_m is None else piece(profile.value, at_m, length_m)


def places_from_crest(rows: Sequence[Row], leads: Sequence[int], found: FoundFaults) -> Mapping[int, float]:
    """Metres from the crest by number, of what is reached over edges with a length; `found` is told where two crests
    disagree."""
    by_number = {row.number: row for row in rows if row.number is not None}
    places: dict[int, tuple[float, int]] = {}
    for lead in leads:
        here: set[int] = set()
        waiting = deque([(lead, 0.0)])
        while waiting:
            number, at = waiting.popleft()
            row = by_number.get(number)
            if row is None or number in here:
                continue
            here.add(number)
            before = places.setdefault(number, (at, lead))
            if abs(before[0] - at) > SHORTEST_GRADE_M:
                found.add(
                    row.place,
                    f"it lies {before[0]:g} m from signal {before[1]} and {at:g} m from signal {lead}, so that "
                    "profile_from_crest has two grades for it; take that out, and give each edge its grade_permille",
                )
                break
            for edge in row.edges:
                to, length = given(edge, "to", None), given(edge, "length_m", None)
                if to is not None and length is not None:
                    waiting.append((to, at + length))
    return {number: at for number, (at, _) in places.items()}


def piece(profile: Grades, at_m: float, length_m: float) -> Grades:
    """The part of `profile` from `at_m` on over `length_m`, its metres from there; a change of grade within
    `SHORTEST_GRADE_M` of an end is moved to that end."""
    begin = max(
        (start, grade) for start, grade in profile if start <= at_m + SHORTEST_GRADE_M or start == profile[0][0]
    )
    inner = (
        (round(start - at_m, DIGITS), grade)
        for start, grade in profile
        if at_m + SHORTEST_GRADE_M < start < at_m + length_m - SHORTEST_GRADE_M
    )
    return ((0.0, begin[1]), *inner)


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
