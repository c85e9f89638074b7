"""The train of the slow simulator: cuts, marks, and what happened.

What the slow simulator is given, and what it tells: a train by its bare numbers, events, and times at joints.
What a cut comes to on a route, in order of the place of its head.
What has happened to a train so far: events, passages, and how near decisions were to their limits.
What the slow simulator refuses, because the model of humping does not speak of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum, IntEnum
from math import inf

from plant_models.hump import Retarder, Route, RouteElement, Signal, Switch

Heads = tuple[tuple[float, float], ...]
"""Of each bend of a route, in order: metres of head that it takes (per (m/s)², whatever the speed)."""


@dataclass(frozen=True)
class SlowCar:
    """A car; `axles_m`: how far its axles are behind its front coupler."""

    length_m: float
    mass_t: float
    axles_m: tuple[float, ...]


@dataclass(frozen=True)
class SlowBody:
    """The cars of a cut, the first ahead, and what holds them up: w0, head wind and air resistance of the whole cut.

    `bend_heads`: heads of the bends of the route to each track; None for a cut that bends do not hold up.
    """

    cars: tuple[SlowCar, ...]
    w0_n_per_kn: float = 0.0
    wind_m_s: float = 0.0
    air_n_per_kn: float = 0.0
    bend_heads: Mapping[int, Heads] | None = None

    @property
    def length_m(self) -> float:
        """Over couplers."""
        return sum(car.length_m for car in self.cars)

    @property
    def mass_t(self) -> float:
        """Q."""
        return sum(car.mass_t for car in self.cars)

    @property
    def fronts_m(self) -> tuple[float, ...]:
        """How far the front coupler of each car is behind the head of the cut."""
        return tuple(sum(car.length_m for car in self.cars[:j]) for j in range(len(self.cars)))

    @property
    def first_axle_m(self) -> float:
        """How far the first axle is behind the head."""
        return self.cars[0].axles_m[0]

    @property
    def last_axle_m(self) -> float:
        """How far the last axle is behind the head."""
        return self.fronts_m[-1] + self.cars[-1].axles_m[-1]

    @property
    def base_m(self) -> float:
        """From the first axle to the last."""
        return self.last_axle_m - self.first_axle_m


def coupled(ahead: SlowBody, behind: SlowBody) -> SlowBody:
    """Both as one: forces add up; one wind blows against both, the mean by what each takes of it."""
    part = behind.mass_t / (ahead.mass_t + behind.mass_t)

    def mean(one: float, other: float) -> float:
        return one + part * (other - one)

    air = mean(ahead.air_n_per_kn, behind.air_n_per_kn)
    from_behind = part * behind.air_n_per_kn / air if air > 0.0 else part
    bends = None
    if ahead.bend_heads is not None and behind.bend_heads is not None:
        bends = {
            track: tuple(
                (mean(one[0], other[0]), mean(one[1], other[1]))
                for one, other in zip(heads, behind.bend_heads[track], strict=True)
            )
            for track, heads in ahead.bend_heads.items()
        }
    wind = ahead.wind_m_s + from_behind * (behind.wind_m_s - ahead.wind_m_s)
    w0 = mean(ahead.w0_n_per_kn, behind.w0_n_per_kn)
    return SlowBody((*ahead.cars, *behind.cars), w0, wind, air, bends)


@dataclass(frozen=True)
class SlowCut:
    """A cut for `track`, let go at `crest_s` with `hump_speed_m_s`; `exit_speeds_m_s`: the command of each position of
    its way, in order; `brake_heads_m`: energy heads of their full brakes, () for brakes without limit."""

    body: SlowBody
    track: int
    crest_s: float
    hump_speed_m_s: float
    exit_speeds_m_s: tuple[float, ...] = ()
    brake_heads_m: tuple[float, ...] = ()


@dataclass(frozen=True)
class SlowTrain:
    """The cuts of a train in order, from the signal `lead`.

    `free_to_m`: where cars stand on each track, from the crest. `linear_n_per_kn`: resistance per m/s; `slope_n_per_kn`
    and `yard_n_per_kn`: what is added under each axle between crest and exit of the last position, and behind it.
    """

    cuts: tuple[SlowCut, ...]
    lead: int
    free_to_m: Mapping[int, float]
    linear_n_per_kn: float = 0.0
    slope_n_per_kn: float = 0.0
    yard_n_per_kn: float = 0.0


class Mark(IntEnum):
    """What a cut comes to: its first or last axle to a joint or a fouling point, its first axle to the entrance of a
    position, its last to the exit, its head to the last section of a track."""

    FIRST_FROM = 0
    LAST_FROM = 1
    FIRST_TO = 2
    LAST_TO = 3
    FIRST_FOULING = 4
    LAST_FOULING = 5
    ENTRANCE = 6
    EXIT = 7
    TRACK = 8


class Kind(Enum):
    """What happens to cuts, as the model of humping names it."""

    NOT_SEPARATED = "not separated"
    MISROUTED = "misrouted"
    CONTACT = "contact"
    FOULED = "fouled"
    STOPPED = "stopped"
    TRACK_CONTACT = "contact on the track"
    COUPLED = "coupled"
    GAP = "gap"


@dataclass(frozen=True)
class SlowEvent:
    """`kind` at the element of this number; `value`: speed of a coupling in m/s; metres of a gap, or that both
    cuts rolled on after a contact on the track; else 0."""

    time_s: float
    kind: Kind
    element: int
    cut: int
    value: float = 0.0


@dataclass(frozen=True)
class Passage:
    """When, and how fast."""

    time_s: float
    speed_m_s: float


@dataclass(frozen=True)
class SlowRun:
    """What came of a train: events in order of time, passages by (cut, element, mark), and of each cut the track to
    which it really went, where its head stood in the end, and whether it was in contact.

    `closest_s`: how near any decision was to its limit; where that is less than the error of times, another simulator
    may rightly decide otherwise.
    """

    events: tuple[SlowEvent, ...]
    passages: Mapping[tuple[int, int, Mark], Passage]
    tracks: tuple[int, ...]
    heads_m: tuple[float, ...]
    in_contact: tuple[bool, ...]
    closest_s: float

    def of(self, kind: Kind) -> tuple[SlowEvent, ...]:
        """The events of one kind."""
        return tuple(event for event in self.events if event.kind is kind)

    def outcome(self) -> set[tuple[str, int, int]]:
        """(kind, element, cut) of all events, without their times."""
        return {(event.kind.value, event.element, event.cut) for event in self.events}

    def time_s(self, cut: int, element: int, mark: Mark) -> float:
        """When; infinite for what never was."""
        passage = self.passages.get((cut, element, mark))
        return passage.time_s if passage is not None else float("inf")


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


class SlowRecord:
    """Events in the order in which they are found; passages by (cut, element, mark)."""

    def __init__(self) -> None:
        self.events: list[SlowEvent] = []
        self.passages: dict[tuple[int, int, Mark], Passage] = {}
        self.decisions: list[tuple[float, int, int, Mark, float]] = []
        self.margins_s: list[float] = []

    def tell(self, time_s: float, kind: Kind, element: int, cut: int, value: float = 0.0) -> None:
        """Note an event."""
        self.events.append(SlowEvent(time_s, kind, element, cut, value))

    def passed(self, j: int, number: int, mark: Mark, time_s: float, delay_s: float = 0.0) -> bool:
        """Whether the last axle of cut `j` was at `mark` by `time_s`, and `delay_s` before that."""
        self.decisions.append((time_s, j, number, mark, delay_s))
        passage = self.passages.get((j, number, mark))
        return passage is not None and passage.time_s + delay_s <= time_s

    def closest(self) -> float:
        """Seconds by which the nearest decision could have been another; infinite where none was made."""
        margins = list(self.margins_s)
        for time_s, j, number, mark, delay_s in self.decisions:
            passage = self.passages.get((j, number, mark))
            if passage is not None:
                margins.append(abs(time_s - passage.time_s - delay_s))
        return min(margins, default=inf)


def require_fit(cut: SlowCut, route: Route, free_to_m: float) -> None:
    """Raise `ValueError` for a cut or a track of which the model does not speak."""
    positions = [(e.at_m, e.at_m + e.vertex.exit_m) for e in route.elements if isinstance(e.vertex, Retarder)]
    if len(cut.exit_speeds_m_s) < len(positions) or 0 < len(cut.brake_heads_m) < len(positions):
        raise ValueError(f"track {route.track}: {len(positions)} positions, and fewer commands or heads")
    if any(speed <= 0.0 for speed in (*cut.exit_speeds_m_s, cut.hump_speed_m_s)):
        raise ValueError("speeds of the hump and commands must be more than 0")
    ends = [0.5 * cut.body.length_m - cut.body.first_axle_m, *(end + cut.body.base_m for _, end in positions)]
    if any(end >= begin for end, (begin, _) in zip(ends, positions, strict=False)):
        raise ValueError(f"track {route.track}: the cut is longer than the way between two positions")
    if not route.elements[-1].from_m < free_to_m <= route.length_m:
        raise ValueError(f"track {route.track}: cars stand at {free_to_m:g} m; it must be on the last section")
