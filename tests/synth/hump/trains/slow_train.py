"""What the slow simulator is given, and what it tells: a train by its bare numbers, events, and times at joints."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum, IntEnum

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
