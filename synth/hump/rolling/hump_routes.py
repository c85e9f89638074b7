"""The routes from one crest as arrays: where each element and position is, and what its points need."""

from __future__ import annotations

from enum import IntEnum
from functools import cached_property

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays, read_only
from plant_models.hump import HumpGraph, Retarder, Route, RouteElement, Signal, Switch


class Mark(IntEnum):
    """What of a cut passes what of an element: its first or last axle, the joint at which cuts come in or go out, or
    the fouling point of a switch."""

    FIRST_IN = 0
    LAST_IN = 1
    FIRST_OUT = 2
    LAST_OUT = 3
    FIRST_CLEAR = 4
    LAST_CLEAR = 5


OF_FIRST_AXLE = np.array([True, False, True, False, True, False])
"""Marks that the first axle makes."""


@frozen_arrays
class HumpRoutes:
    """Routes of `graph` from the signal `lead`, a row each by track; build it with `hump_routes`.

    Elements are those on which cuts can meet: the signal and the last section of a track are none. Two routes share
    their first elements, in the same columns. Arrays (routes, elements): `vertex`, place in `numbers`, −1 behind the
    last element; `place_m` with the marks as a third axis, infinite behind the last element; `points`, how the route
    wants them: 0 left, 1 right, −1 for what is no switch; `throw_s` with relays, 0 for what is no switch. (routes,
    positions): `entrance_m`, `exit_m`, infinite where a route has fewer; `retarder`, the column of the element.
    """

    graph: HumpGraph
    lead: int
    routes: tuple[Route, ...]
    numbers: tuple[int, ...]
    vertex: Ints
    place_m: Floats
    points: Ints
    throw_s: Floats
    retarder: Ints
    entrance_m: Floats
    exit_m: Floats
    length_m: Floats

    @property
    def tracks(self) -> Ints:
        """Number of the track of each route."""
        return np.array([route.track for route in self.routes])

    @property
    def first_element(self) -> tuple[int, float]:
        """Number of the element that all cuts come to first, and how far the track has fallen from the crest to it."""
        from_m = self.place_m[0, 0, Mark.FIRST_IN]
        return self.numbers[self.vertex[0, 0]], float(self.routes[0].roll_track.fall_m(from_m))

    @property
    def elements(self) -> int:
        """Most elements of a route."""
        return int(self.vertex.shape[1])

    @cached_property
    def retarder_numbers(self) -> Ints:
        """Numbers of the elements of the positions, (routes, positions); −1 where a route has fewer."""
        rows = np.arange(len(self.routes))[:, None]
        numbers = np.array(self.numbers)[self.vertex[rows, self.retarder]]
        return read_only(np.where(self.retarder >= 0, numbers, -1))

    @property
    def positions(self) -> int:
        """Most positions of a route."""
        return int(self.entrance_m.shape[1])

    @cached_property
    def positions_of(self) -> Ints:
        """Positions of each route, (routes,); the number of its last one."""
        return read_only(np.isfinite(self.entrance_m).sum(axis=1))

    @cached_property
    def parts_behind(self) -> Bools:
        """Whether there is a switch behind the last position of each route, (routes,)."""
        last = self.retarder.max(axis=1, initial=-1)
        return read_only(((self.points >= 0) & (np.arange(self.elements) > last[:, None])).any(axis=1))

    @cached_property
    def is_last(self) -> Bools:
        """Whether each of the `numbers` is the last position of some route."""
        rows, last = np.arange(len(self.routes)), self.retarder.max(axis=1, initial=-1)
        return read_only(np.isin(np.arange(len(self.numbers)), self.vertex[rows, last][last >= 0]))

    @cached_property
    def release_m(self) -> Floats:
        """Where the last position of each route ends, (routes,); 0 where it has none."""
        return read_only(self.exit_m.max(axis=1, initial=0.0, where=np.isfinite(self.exit_m)))

    @cached_property
    def even(self) -> bool:
        """Whether all routes have as many positions."""
        return bool((self.positions_of == self.positions).all())

    @cached_property
    def ends_m(self) -> Floats:
        """Where a last axle is out of the last element of its route, (routes,)."""
        out = self.place_m[:, :, Mark.LAST_OUT]
        return read_only(out.max(axis=1, initial=0.0, where=np.isfinite(out)))

    @cached_property
    def standing_from_m(self) -> Floats:
        """From where on cars may stand on the track of each route, (routes,): behind its last position and switch."""
        clear = self.place_m[:, :, Mark.LAST_CLEAR]
        begins = np.array([route.yard_from_m for route in self.routes])
        return read_only(clear.max(axis=1, initial=0.0, where=self.points >= 0).clip(begins, self.length_m))

    def shared(self, one: Ints, other: Ints) -> Ints:
        """How many of their first elements the routes `one` and `other` (n,) share: up to the switch that parts them.

        Where both are the same route, all of them.
        """
        same = (self.vertex[one] == self.vertex[other]) & (self.vertex[one] >= 0)
        return np.asarray(np.logical_and.accumulate(same, axis=1).sum(axis=1))


def hump_routes(graph: HumpGraph, lead: int) -> HumpRoutes:
    """The routes of `graph` from the signal `lead`; `HumpError` if there is no crest there."""
    routes = tuple(graph.routes(lead).values())
    met = [[e for e in route.elements[:-1] if not isinstance(e.vertex, Signal)] for route in routes]
    held = [[e for e in elements if isinstance(e.vertex, Retarder)] for elements in met]
    numbers = tuple(sorted({e.number for elements in met for e in elements}))
    shape = len(routes), max(map(len, met))
    vertex, points = np.full(shape, -1), np.full(shape, -1)
    place, throw = np.full((*shape, len(Mark)), np.inf), np.zeros(shape)
    most = max(map(len, held))
    retarder = np.full((len(routes), most), -1)
    entrance, leave = np.full(retarder.shape, np.inf), np.full(retarder.shape, np.inf)
    for row, (route, elements) in enumerate(zip(routes, met, strict=True)):
        for column, element in enumerate(elements):
            vertex[row, column] = numbers.index(element.number)
            place[row, column] = marks_m(route, element)
            if isinstance(element.vertex, Switch):
                points[row, column] = element.position
                throw[row, column] = element.vertex.throw_s + element.vertex.relay_s
        for position, element in enumerate(held[row]):
            assert isinstance(element.vertex, Retarder)
            retarder[row, position] = elements.index(element)
            entrance[row, position], leave[row, position] = element.at_m, element.at_m + element.vertex.exit_m
    length = np.array([route.length_m for route in routes])
    return HumpRoutes(graph, lead, routes, numbers, vertex, place, points, throw, retarder, entrance, leave, length)


def marks_m(route: Route, element: RouteElement) -> list[float]:
    """Places of the marks of an element, metres from the crest; what has no fouling point is clear at its end."""
    clear = route.fouling_m(element.number) if isinstance(element.vertex, Switch) else element.to_m
    return [element.from_m, element.from_m, element.to_m, element.to_m, clear, clear]
