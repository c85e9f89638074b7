"""What stands where on the ways of a hump: metres and fall from the crest, and how fast the design runners come."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from plant_models.hump import HumpGraph, Retarder, Route, RouteElement, Switch, TrackSection
from synth.hump.design_runners import DESIGN_RUNNERS, RunnerRoll, roll_runners
from synth.kernels.cache import guarded

DIGITS = 3
"""Of metres by which places are told apart."""


@dataclass(frozen=True)
class RolledRoute:
    """A route, and how the good and the bad runner roll over it without brakes."""

    route: Route
    good: RunnerRoll
    bad: RunnerRoll

    def fall_m(self, at_m: float) -> float:
        """From the crest to `at_m`."""
        return float(self.route.roll_track.fall_m(np.array([at_m]))[0])

    @property
    def retarders(self) -> tuple[RouteElement, ...]:
        """From the crest on."""
        return tuple(each for each in self.route.elements if isinstance(each.vertex, Retarder))

    @property
    def switches(self) -> tuple[RouteElement, ...]:
        """From the crest on."""
        return tuple(each for each in self.route.elements if isinstance(each.vertex, Switch))

    @property
    def last_m(self) -> float:
        """Behind the last switch and the last position; 0 where there is none."""
        return max((each.to_m for each in (*self.switches, *self.retarders)), default=0.0)

    @property
    def track_m(self) -> float:
        """Where its track begins."""
        of_track = (e.at_m for e in self.route.elements if isinstance(e.vertex, TrackSection) and e.vertex.track)
        return next(of_track)


def rolled_routes(graph: HumpGraph) -> tuple[RolledRoute, ...]:
    """Every route of the hump, with the design runners on it."""
    routes = [route for lead in graph.leads for route in graph.routes(lead).values()]
    runners = (DESIGN_RUNNERS[0], DESIGN_RUNNERS[-1])
    return tuple(RolledRoute(route, *guarded(roll_runners, route, runners)) for route in routes)


@dataclass(frozen=True)
class Place:
    """Elements `numbers` of one `kind` that lie equally far from the crest: at `at_m`, their insulated sections from
    `from_m` to `to_m`; of tracks the numbers are those of the tracks.

    `fall_m`: from the crest, the least of all ways. `good_m_s`: of the good runner, the fastest; `bad_m_s`: of the bad
    one, the slowest; None where it stands before.
    """

    kind: str
    numbers: tuple[int, ...]
    at_m: float
    from_m: float
    to_m: float
    fall_m: float
    good_m_s: float | None
    bad_m_s: float | None


def places_of(rolled: Sequence[RolledRoute]) -> tuple[Place, ...]:
    """Of all routes, from the crest on."""
    met: dict[tuple[float, str, float, float], list[tuple[int, RolledRoute]]] = {}
    for each in rolled:
        for kind, number, element in elements_of(each.route):
            at, begin, end = (round(metres, DIGITS) for metres in (element.at_m, element.from_m, element.to_m))
            met.setdefault((at, kind, begin, end), []).append((number, each))
    return tuple(place_of(*key, met[key]) for key in sorted(met))


def place_of(at_m: float, kind: str, from_m: float, to_m: float, found: Sequence[tuple[int, RolledRoute]]) -> Place:
    """The place of the elements `found`, each with the ways on which it lies."""
    good = [speed_at(each.good, at_m) for _, each in found]
    bad = [speed_at(each.bad, at_m) for _, each in found]
    fast = [speed for speed in good if speed is not None]
    slow = [speed for speed in bad if speed is not None]
    return Place(
        kind,
        numbers=tuple(sorted({number for number, _ in found})),
        at_m=at_m,
        from_m=from_m,
        to_m=to_m,
        fall_m=min(each.fall_m(at_m) for _, each in found),
        good_m_s=max(fast, default=None),
        bad_m_s=min(slow) if len(slow) == len(bad) else None,
    )


def elements_of(route: Route) -> Iterator[tuple[str, int, RouteElement]]:
    """(kind, number, element) of what the place is told of."""
    for element in route.elements[1:]:
        vertex = element.vertex
        if isinstance(vertex, TrackSection) and vertex.track is not None:
            yield "track", vertex.track, element
        else:
            kind = {Switch: "switch", Retarder: "retarder", TrackSection: "section"}.get(type(vertex), "signal")
            yield kind, element.number, element


def speed_at(roll: RunnerRoll, at_m: float) -> float | None:
    """With its middle there; None where the runner stands before."""
    if at_m >= roll.stop_m or at_m > roll.at_m[-1] + 1.0:
        return None
    return float(np.interp(at_m, roll.at_m, roll.speed_m_s))
