"""What a cut comes to on a route, in order of the place of its head."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models.hump import Retarder, Route, RouteElement, Signal, Switch
from tests.synth.hump.trains.slow_train import Mark, SlowBody

FIRST_AXLE = frozenset({Mark.FIRST_FROM, Mark.FIRST_TO, Mark.FIRST_FOULING, Mark.ENTRANCE})


@dataclass(frozen=True, order=True)
class MarkAt:
    """`mark` of the element `order` of the route, when the head is at `head_m` and the axle at `place_m`."""

    head_m: float
    order: int
    mark: Mark
    place_m: float


def places_of(element: RouteElement, route: Route) -> list[tuple[Mark, float]]:
    """Places of the marks of one element of `route`, none of a signal."""
    vertex = element.vertex
    if isinstance(vertex, Signal):
        return []
    found = [(Mark.FIRST_FROM, element.from_m), (Mark.LAST_FROM, element.from_m)]
    if element is route.elements[-1]:
        return [*found, (Mark.TRACK, element.from_m)]
    found += [(Mark.FIRST_TO, element.to_m), (Mark.LAST_TO, element.to_m)]
    if isinstance(vertex, Switch):
        place = route.fouling_m(vertex.number)
        found += [(Mark.FIRST_FOULING, place), (Mark.LAST_FOULING, place)]
    if isinstance(vertex, Retarder):
        found += [(Mark.ENTRANCE, element.at_m), (Mark.EXIT, element.at_m + vertex.exit_m)]
    return found


def marks_of(body: SlowBody, route: Route) -> list[MarkAt]:
    """All marks of a cut on `route`, in the order in which it comes to them."""
    marks = []
    for order, element in enumerate(route.elements):
        for mark, place in places_of(element, route):
            behind = 0.0
            if mark is not Mark.TRACK:
                behind = body.first_axle_m if mark in FIRST_AXLE else body.last_axle_m
            marks.append(MarkAt(place + behind, order, mark, place))
    return sorted(marks)
