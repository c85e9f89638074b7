"""What a hump is, for programs: its elements, routes and lists of tracks, and where its numbers are from."""

from __future__ import annotations

from typing import Any

from plant_models.hump import HumpGraph, Route, Signal, Switch
from plant_models.library.hump_entry import HumpEntry
from plant_models.library.sourced_value import SourcedValue


def checked_document(hump: HumpEntry) -> dict[str, Any]:
    """What `hump check` tells of `hump`."""
    graph = hump.graph
    routes = [route for lead in graph.leads for route in graph.routes(lead).values()]
    edges = [edge for vertex in graph.vertices for edge in vertex.edges]
    return {
        "title": hump.title,
        "leads": list(graph.leads),
        "tracks": len(graph.tracks),
        "switches": len(graph.switches),
        "signals": len(graph.signals),
        "retarders": len(graph.retarders),
        "sections": len(graph.sections),
        "axle_counters": sum(not isinstance(v, Signal) and v.axle_counters for v in graph.vertices),
        "point_sensors": sum(len(edge.point_sensors) for edge in edges),
        "radars": sum(len(edge.radars) for edge in edges),
        "routes": len(routes),
        "route_length_m": [min(r.length_m for r in routes), max(r.length_m for r in routes)],
        "switches_on_a_route": [min(len(r.positions) for r in routes), max(len(r.positions) for r in routes)],
        "retarders_with_book": [each.number for each in graph.retarders if each.book is not None],
        "retarders_by_exit_std_m_s": retarders_by_exit_std(graph),
        "retarders_without_aim_tables": [each.number for each in graph.retarders if not each.aim_tables],
        "numbers": counted(hump.provenance),
    }


def retarders_by_exit_std(graph: HumpGraph) -> dict[str, list[int]]:
    """Retarders of whose controller only the standard deviation of the exit speeds is known, by that (m/s)."""
    found: dict[str, list[int]] = {}
    for each in sorted(graph.retarders, key=lambda each: (each.exit_std_m_s or 0.0, each.number)):
        if each.exit_std_m_s is not None:
            found.setdefault(f"{each.exit_std_m_s:g}", []).append(each.number)
    return found


def counted(numbers: tuple[SourcedValue, ...]) -> dict[str, int]:
    """How many of the numbers of a file are cited, assumed, and told without a source."""
    told = [value for value in numbers if value.source]
    assumed = sum(value.assumed for value in told)
    return {"cited": len(told) - assumed, "assumed": assumed, "without_source": len(numbers) - len(told)}


def routes_document(graph: HumpGraph) -> dict[str, Any]:
    """Every route, and the lists of tracks of every switch."""
    return {
        "routes": [route_document(route) for lead in graph.leads for route in graph.routes(lead).values()],
        "switches": [
            {
                "number": switch.number,
                "left_tracks": list(graph.left_tracks(switch.number)),
                "right_tracks": list(graph.right_tracks(switch.number)),
            }
            for switch in graph.switches
        ],
    }


def route_document(route: Route) -> dict[str, Any]:
    """A route with its elements in order, metres from the crest."""
    elements: list[dict[str, Any]] = []
    for element in route.elements:
        told: dict[str, Any] = {"number": element.number, "at_m": round(element.at_m, 6)}
        told |= {"section_m": [round(element.from_m, 6), round(element.to_m, 6)]}
        if isinstance(element.vertex, Switch):
            told |= {"position": element.position, "fouling_m": round(route.fouling_m(element.number), 6)}
        elements.append(told)
    return {
        "lead": route.lead,
        "track": route.track,
        "code": route.code,
        "length_m": round(route.length_m, 6),
        "free_to_m": round(route.free_to_m, 6),
        "elements": elements,
    }
