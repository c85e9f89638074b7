"""The profile of a hump in metres from the crest: the grades of every edge follow from it."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from plant_models.hump.edge import SHORTEST_GRADE_M, Grades
from plant_models.library.hump_cells import Cell, Cells, Origin
from plant_models.library.hump_elements import given
from plant_models.library.hump_faults import FoundFaults
from plant_models.library.hump_row import Row

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
