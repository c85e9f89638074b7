"""The other models that the control works with, as the published model has them: a trainer plugs in its own.

Track geometry tells which object occupies which section and moves points; technology decides what is done with a cut
that cannot go where the list says.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from synth.hump.control.event import Why

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
