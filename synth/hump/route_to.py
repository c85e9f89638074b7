"""The route to one track of a hump."""

from __future__ import annotations

from plant_models.hump import HumpGraph, Route
from synth.frame.input_error import InputError
from synth.frame.printed_numbers import ranges


def route_to(graph: HumpGraph, track: int) -> Route:
    """The route to `track` from the first crest that reaches it; `InputError` where there is no such track."""
    for lead in graph.leads:
        routes = graph.routes(lead)
        if track in routes:
            return routes[track]
    raise InputError(f"--track is {track}; the hump has the tracks {ranges(graph.tracks)}")
