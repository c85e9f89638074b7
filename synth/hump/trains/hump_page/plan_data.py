"""The plan of a hump and the ways of its routes on it, as plain data for the page: metres along, rows across."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from plant_models.hump import HumpGraph, Retarder, Route, Switch, TrackSection
from synth.hump.control.pictures.plan_layout import PlanLayout, plan_layout

Data = dict[str, Any]


def plan_data(graph: HumpGraph, routes: Mapping[int, Route]) -> Data:
    """What is drawn once; `routes`: those of the cuts, by the numbers that the page knows them by."""
    layout = plan_layout(graph)
    last = max(layout.at[vertex.number][0] for vertex in graph.vertices)
    return {
        "rows": len(layout.row),
        "last_m": rounded(last),
        "end_m": rounded(max(layout.end_m.values())),
        "rails": list(rails(graph, layout)),
        "sections": list(sections(graph, layout)),
        "zones": [zone for each in graph.retarders for zone in zones(each, layout)],
        "switches": [[each.number, *map(rounded, layout.at[each.number])] for each in graph.switches],
        "signals": [[each.number, *map(rounded, layout.at[each.number])] for each in graph.signals],
        "retarders": [[each.number, *map(rounded, layout.at[each.number])] for each in graph.retarders],
        "tracks": [[track, rounded(layout.end_m[track]), row] for track, row in layout.row.items()],
        "called": {str(each.number): graph.called(each.number) for each in graph.vertices},
        "tracks_called": {str(track): graph.track_called(track) for track in layout.row},
        "routes": {str(row): way(route, layout) for row, route in routes.items()},
    }


def rails(graph: HumpGraph, layout: PlanLayout) -> Iterator[list[float]]:
    """Ends of every edge (x, y, x, y); a track's last one goes to its end."""
    for vertex in graph.vertices:
        x, y = layout.at[vertex.number]
        for edge in vertex.edges:
            to_x, to_y = layout.at[edge.to] if edge.to is not None else (x + edge.length_m, y)
            yield [rounded(value) for value in (x, y, to_x, to_y)]


def sections(graph: HumpGraph, layout: PlanLayout) -> Iterator[Data]:
    """The insulated sections, each with its number and its lines."""
    for vertex in graph.vertices:
        if isinstance(vertex, TrackSection) and vertex.is_last:
            continue
        ahead, behind = vertex.section_m
        if behind <= 0.0:
            continue
        x, y = layout.at[vertex.number]
        lines = [[x - ahead, y, x, y]] if isinstance(vertex, Switch) and ahead > 0.0 else []
        for edge in vertex.edges:
            assert edge.to is not None
            lines.append([x, y, *along(layout, vertex.number, edge.to, behind)])
        kind = "switch" if isinstance(vertex, Switch) else "retarder" if isinstance(vertex, Retarder) else "plain"
        yield {"number": vertex.number, "kind": kind, "lines": [[rounded(v) for v in line] for line in lines]}


def zones(retarder: Retarder, layout: PlanLayout) -> Iterator[Data]:
    """The braking zones of a retarder."""
    assert retarder.next.to is not None
    for begin, end in retarder.zones_m:
        ends = (value for place in (begin, end) for value in along(layout, retarder.number, retarder.next.to, place))
        yield {"number": retarder.number, "line": [rounded(value) for value in ends]}


def along(layout: PlanLayout, number: int, to: int, metres: float) -> tuple[float, float]:
    """The place so many metres behind an element on its edge to another."""
    (x, y), (to_x, to_y) = layout.at[number], layout.at[to]
    return x + metres, y + metres * (to_y - y) / (to_x - x)


def way(route: Route, layout: PlanLayout) -> list[list[float]]:
    """(metres of the route, x, y) at each element and at the end."""
    points = [[element.at_m, *layout.at[element.number]] for element in route.elements]
    (m, x, y) = points[-1]
    points.append([route.length_m, x + route.length_m - m, y])
    return [[rounded(value) for value in point] for point in points]


def rounded(value: float) -> float:
    """To a millimetre."""
    return round(float(value), 3)
