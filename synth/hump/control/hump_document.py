"""The routes of a hump and the lists of tracks of its switches, for programs."""

from __future__ import annotations

from typing import Any

from plant_models.hump import HumpGraph, Route, Switch


def routes_document(graph: HumpGraph) -> dict[str, Any]:
    """Every route, and the lists of tracks of every switch."""
    return {
        "routes": [route_document(route, graph) for lead in graph.leads for route in graph.routes(lead).values()],
        "switches": [
            {
                "number": switch.number,
                "name": switch.name,
                "left_tracks": list(graph.left_tracks(switch.number)),
                "right_tracks": list(graph.right_tracks(switch.number)),
            }
            for switch in graph.switches
        ],
    }


def route_document(route: Route, graph: HumpGraph) -> dict[str, Any]:
    """A route of `graph` with its elements in order, metres from the crest."""
    elements: list[dict[str, Any]] = []
    for element in route.elements:
        told: dict[str, Any] = {"number": element.number, "name": graph.names.get(element.number)}
        told |= {"at_m": round(element.at_m, 6), "section_m": [round(element.from_m, 6), round(element.to_m, 6)]}
        if isinstance(element.vertex, Switch):
            told |= {"position": element.position, "fouling_m": round(route.fouling_m(element.number), 6)}
        elements.append(told)
    return {
        "lead": route.lead,
        "track": route.track,
        "track_name": graph.track_names.get(route.track),
        "code": route.code,
        "length_m": round(route.length_m, 6),
        "free_to_m": round(route.free_to_m, 6),
        "elements": elements,
    }
