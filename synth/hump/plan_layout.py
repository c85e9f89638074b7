"""Where each element of a hump is drawn in the track plan: along in metres from the crest, across in rows of tracks."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass

from plant_models.hump import HumpGraph


@dataclass(frozen=True)
class PlanLayout:
    """`at` (metres from the crest, row) of each element; `end_m`, `row` of each track, the leftmost track in row 0.

    Rows are in the order of the tracks from left to right; across, the plan is not to scale.
    """

    at: Mapping[int, tuple[float, float]]
    end_m: Mapping[int, float]
    row: Mapping[int, int]


def plan_layout(graph: HumpGraph) -> PlanLayout:
    """Each element stands in the middle of the tracks behind it; an element of one of two crests beside that."""
    row: dict[int, int] = {}
    metres: dict[int, float] = {}
    end_m: dict[int, float] = {}
    rows: defaultdict[int, set[int]] = defaultdict(set)
    reached_by: defaultdict[int, set[int]] = defaultdict(set)
    leads_of_track: defaultdict[int, set[int]] = defaultdict(set)
    for lead in graph.leads:
        for route in sorted(graph.routes(lead).values(), key=lambda route: route.code):
            place = row.setdefault(route.track, len(row))
            end_m.setdefault(route.track, route.length_m)
            leads_of_track[route.track].add(lead)
            for element in route.elements:
                metres.setdefault(element.number, element.at_m)
                reached_by[element.number].add(lead)
                rows[element.number].add(place)
    by_row = {place: track for track, place in row.items()}
    at: dict[int, tuple[float, float]] = {}
    for number, places in rows.items():
        across = sum(places) / len(places)
        shared = {lead for place in places for lead in leads_of_track[by_row[place]]}
        if len(reached_by[number]) == 1 and len(shared) > 1:
            leads = sorted(shared, key=graph.leads.index)
            apart = leads.index(next(iter(reached_by[number]))) - (len(leads) - 1) / 2.0
            across += apart * 0.15 * len(row)
        at[number] = (metres[number], across)
    return PlanLayout(at, end_m, row)
