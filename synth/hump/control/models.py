"""What the control works with: rules of practice besides the published model, and the other models, as that has them; a
trainer plugs in its own.

Track geometry tells which object occupies which section and moves points; technology decides what is done with a cut
that cannot go where the list says ([kozachenko-control], [hump-computer-1970s]).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from plant_models.errors import require_between
from synth.hump.control.events import Why


@dataclass(frozen=True)
class PracticeRules:
    """Which rules hold.

    `counters`: points are not thrown while the counters of their section wait for axles, so a long car is held that
    stands over a short section (long-base rule), and so are a falsely free section and the rest of a split cut.
    `fouling_m_s`: points are not thrown while a cut behind them is slower than this limit and short of the fouling
    point; None: no such rule. `lone_axle_s`: counters that contradict each other on a free section are put right after
    this time, if the next section counted the whole cut (filter of lone axles). `usual_base_m`, `longest_base_m`: no
    car has more between two axles, the latter if its cut has the mark long-base; a longer gap in a cut is a wrong
    uncoupling. `coupled_gap_m`: the last and the first axle of two coupled cars are no further apart. `bogie_m`:
    between the axles of a bogie. `slowest_m_s`: moving cuts are no slower.
    """

    counters: bool = True
    fouling_m_s: float | None = 1.0
    lone_axle_s: float = 1.0
    usual_base_m: float = 12.0
    longest_base_m: float = 30.0
    coupled_gap_m: float = 6.0
    bogie_m: float = 1.85
    slowest_m_s: float = 2.0

    def __post_init__(self) -> None:
        if self.fouling_m_s is not None:
            require_between("rules: fouling_m_s", self.fouling_m_s, 0.0, 10.0)
        require_between("rules: lone_axle_s", self.lone_axle_s, 0.0, 60.0)
        require_between("rules: longest_base_m", self.longest_base_m, 5.0, 60.0)
        require_between("rules: usual_base_m", self.usual_base_m, 2.0, self.longest_base_m)
        require_between("rules: coupled_gap_m", self.coupled_gap_m, 2.0, 20.0)
        require_between("rules: bogie_m", self.bogie_m, 1.0, 4.0)
        require_between("rules: slowest_m_s", self.slowest_m_s, 0.1, 10.0)

    @property
    def crawl_m_s(self) -> float:
        """A gap next to an axle that was slower on the first section is not judged: it may have stood there."""
        return 0.5 * self.slowest_m_s

    @property
    def bogie_s(self) -> float:
        """An axle that comes so soon behind another is of the same car."""
        return self.bogie_m / self.slowest_m_s

    @property
    def patience_s(self) -> float:
        """How long a free section may wait for axles of a cut before they count as missing."""
        return self.longest_base_m / self.slowest_m_s


PUBLISHED_MODEL = PracticeRules(counters=False, fouling_m_s=None)
"""The published model alone: a free section is enough."""


ENTRY = -1
"""End of a section where cuts come in; the others are the branches, 0 left, 1 right, and 0 of what is no switch."""


class AxlePass(NamedTuple):
    """One axle over the counter at an end of a section: `end` is ENTRY or a branch."""

    time_s: float
    element: int
    end: int


class Occupation(NamedTuple):
    """The objects on a section, the one ahead first; () where it is free."""

    element: int
    objects: tuple[int, ...]


class Resistance(NamedTuple):
    """A retarder brakes with this resistance, N/kN."""

    n_per_kn: float


class ExitSpeed(NamedTuple):
    """An exported table brakes a cut to this exit speed."""

    m_s: float


Braking = Resistance | ExitSpeed
"""What a retarder is told."""


class TrackGeometry(Protocol):
    """Tracks and what stands on them. The three readings tell what changed since they were asked last."""

    def advance(self, time_s: float) -> None:
        """Bring everything to `time_s`, which never falls."""

    def occupations(self) -> Iterable[Occupation]:
        """Sections whose objects changed."""

    def axles(self) -> Iterable[AxlePass]:
        """Axles that passed a counter, by time."""

    def positions(self) -> Iterable[tuple[int, int]]:
        """Points whose detected position changed: (switch, 0 | 1 | −1 on the way)."""

    def throw(self, switch: int, position: int) -> None:
        """Command points."""

    def brake(self, retarder: int, braking: Braking | None) -> None:
        """Command a retarder; None opens it."""

    def show(self, signal: int, aspect: int) -> None:
        """Command a signal."""

    def is_fouled(self, switch: int, slowest_m_s: float) -> bool:
        """Whether a cut behind the points is slower than `slowest_m_s` and short of the fouling point."""

    def place_m(self, cut: int) -> float:
        """Where its first axle is, metres from the crest."""

    def speed_m_s(self, cut: int) -> float:
        """How fast it is."""


@dataclass(frozen=True)
class Misroute:
    """A cut that cannot go where the list says: at which element, why, behind which leader (0: none), which tracks it
    can still reach, in order, and where it and its leader were to go."""

    cut: int
    element: int
    why: Why
    leader: int
    reachable: tuple[int, ...]
    track: int
    leader_track: int | None


Technology = Callable[[Misroute], int]
"""What the yard does with a cut that cannot go where the list says: the track to which it goes, one of `reachable`."""


ResortingCost = Callable[[int, int], float]
"""From the track where a cut stands and the track where it belongs to what it costs to bring it there."""


def leader_track(misroute: Misroute) -> int:
    """The follower goes to the track of its leader: what the published model does unless told otherwise.

    Without a leader, or where its track cannot be reached, the cut keeps its own track, or goes to the first that can
    be reached.
    """
    for track in (misroute.leader_track, misroute.track):
        if track is not None and track in misroute.reachable:
            return track
    return misroute.reachable[0]


@dataclass(frozen=True)
class RejectionOrCheapest:
    """To a rejection track, the first of `rejection` that can be reached; else to the track from which the cut is
    brought to its own at least cost, of equal ones the one with the smaller number."""

    rejection: tuple[int, ...]
    cost: ResortingCost

    def __call__(self, misroute: Misroute) -> int:
        """A rejection track or the cheapest."""
        for track in self.rejection:
            if track in misroute.reachable:
                return track
        return min(misroute.reachable, key=lambda track: (self.cost(track, misroute.track), track))
