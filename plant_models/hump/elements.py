"""The elements of a hump, vertices of its graph: signals, switches, retarders, and sections of plain track."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from plant_models.errors import require, require_none
from plant_models.hump.edge import Edge
from plant_models.hump.ranges import (
    ENTRY_JOINT_M,
    EXIT_STD_M_S,
    FOULING_M,
    LENGTH_M,
    RELAY_S,
    RETARDER_EXIT_JOINT_M,
    RETARDERS,
    SECTIONS,
    SIGNALS,
    STANDING_M,
    SWITCH_EXIT_JOINT_M,
    SWITCHES,
    THROW_S,
    TRACK,
    TURN_DEG,
    ZONE_M,
)


@dataclass(frozen=True)
class Signal:
    """A signal; at a crest it stands where the fall begins. It has no insulated section."""

    number: int
    next: Edge

    def __post_init__(self) -> None:
        SIGNALS.checked(self.number)

    @property
    def edges(self) -> tuple[Edge, ...]:
        """The one edge."""
        return (self.next,)

    @property
    def section_m(self) -> tuple[float, float]:
        """Metres of the insulated section (ahead of the element, behind it): none."""
        return 0.0, 0.0


LEFT: Final = 0
RIGHT: Final = 1
"""Positions of a switch, s of the published model."""


@dataclass(frozen=True)
class Branch:
    """One branch of a switch: its `edge`, how many degrees it turns aside from the track ahead, and its fouling point.

    `fouling_m`: from the points; a car whose tail is not beyond it stands in the way of cars on the other branch.
    """

    edge: Edge
    turn_deg: float
    fouling_m: float

    def __post_init__(self) -> None:
        require_none((*TURN_DEG.faults("turn_deg", self.turn_deg), *FOULING_M.faults("fouling_m", self.fouling_m)))


@dataclass(frozen=True)
class Switch:
    """A switch, whose element is at the points (tips of the blades); its edges begin there.

    The insulated section reaches from `entry_joint_m` ahead of the points to `exit_joint_m` behind them on both
    branches. The machine throws the points in `throw_s`; `relay_s` passes before it starts. With `axle_counters` there
    is one at each of its three joints. `name`: what the yard calls it. Raises `PlantError`.
    """

    number: int
    left: Branch
    right: Branch
    entry_joint_m: float
    exit_joint_m: float
    throw_s: float
    relay_s: float
    axle_counters: bool = True
    name: str | None = None

    def __post_init__(self) -> None:
        SWITCHES.checked(self.number)
        require_none(
            (
                *ENTRY_JOINT_M.faults("entry_joint_m", self.entry_joint_m),
                *SWITCH_EXIT_JOINT_M.faults("exit_joint_m", self.exit_joint_m),
                *THROW_S.faults("throw_s", self.throw_s),
                *RELAY_S.faults("relay_s", self.relay_s),
            )
        )

    @property
    def branches(self) -> tuple[Branch, Branch]:
        """By position: left, right."""
        return self.left, self.right

    @property
    def edges(self) -> tuple[Edge, ...]:
        """Left, right."""
        return self.left.edge, self.right.edge

    @property
    def section_m(self) -> tuple[float, float]:
        """Metres of the insulated section (ahead of the element, behind it)."""
        return self.entry_joint_m, self.exit_joint_m


@dataclass(frozen=True)
class Retarder:
    """A retarder position of one track, whose element is at its entrance; its edge begins there.

    `zones_m`: (begin, end) of each braking zone from the entrance, in order. The insulated section reaches from
    `entry_joint_m` ahead of the entrance to `exit_joint_m` behind it, the last zone included. `position`: name in the
    library of retarder positions. Its controller is told by one of two: `book`, the file of its tables as the hump's
    file names it, or `exit_std_m_s` (m/s) where no more is known: the standard deviation of its exit speeds from the
    commanded ones, 0 for an ideal one. `aim_tables`: files of aim tables, beside either. `name`: what the yard calls
    it. Raises `PlantError`.
    """

    number: int
    next: Edge
    zones_m: tuple[tuple[float, float], ...]
    entry_joint_m: float
    exit_joint_m: float
    position: str
    book: str | None = None
    aim_tables: tuple[str, ...] = ()
    axle_counters: bool = True
    exit_std_m_s: float | None = None
    name: str | None = None

    def __post_init__(self) -> None:
        RETARDERS.checked(self.number)
        require_none(self._faults())

    def _faults(self) -> Iterator[str]:
        yield from self._faults_of_zones()
        yield from ENTRY_JOINT_M.faults("entry_joint_m", self.entry_joint_m)
        yield from RETARDER_EXIT_JOINT_M.faults("exit_joint_m", self.exit_joint_m)
        if self.zones_m and not self.exit_joint_m >= self.exit_m:
            yield (
                f"exit_joint_m is {self.exit_joint_m:g}; it must not be before the end of the last zone, "
                f"{self.exit_m:g} m"
            )
        if self.book is None and self.exit_std_m_s is None:
            yield (
                "nothing controls it; give book, the file of its tables, or exit_std_m_s, the standard deviation of "
                "its exit speeds, 0 to 1"
            )
        if self.book is not None and self.exit_std_m_s is not None:
            yield "book and exit_std_m_s are both given; give the one that tells what controls it"
        if self.exit_std_m_s is not None:
            yield from EXIT_STD_M_S.faults("exit_std_m_s", self.exit_std_m_s)

    def _faults_of_zones(self) -> Iterator[str]:
        if not self.zones_m:
            yield "zones_m: there is none; a retarder must have at least one braking zone"
        for begin, end in self.zones_m:
            yield from ZONE_M.faults("zones_m: a begin", begin)
            yield from ZONE_M.faults("zones_m: an end", end)
            if not end > begin:
                yield f"zones_m: a zone ends at {end:g} m; it must end behind its begin, {begin:g} m"
        for ahead, behind in pairwise(self.zones_m):
            if not behind[0] >= ahead[1]:
                yield (f"zones_m: a zone begins at {behind[0]:g} m, before the one ahead of it ends at {ahead[1]:g} m")

    @property
    def exit_m(self) -> float:
        """End of the last zone, from the entrance."""
        return self.zones_m[-1][1]

    @property
    def edges(self) -> tuple[Edge, ...]:
        """The one edge."""
        return (self.next,)

    @property
    def section_m(self) -> tuple[float, float]:
        """Metres of the insulated section (ahead of the element, behind it)."""
        return self.entry_joint_m, self.exit_joint_m


@dataclass(frozen=True)
class TrackSection:
    """An insulated section of `length_m`, whose element and edge begin where the section does.

    `track`: number of the classification track that it is part of, None on the way there. The last section of a track
    has an edge to nowhere and is as long as that; `standing_m` of cars stand at its far end. `name`: what the yard
    calls it; that of the last section is the track's. Raises `PlantError`.
    """

    number: int
    next: Edge
    length_m: float
    track: int | None = None
    standing_m: float = 0.0
    axle_counters: bool = True
    name: str | None = None

    def __post_init__(self) -> None:
        SECTIONS.checked(self.number)
        LENGTH_M.require("length_m", self.length_m)
        if self.track is not None:
            TRACK.require("track", self.track)
        STANDING_M.require("standing_m", self.standing_m)
        if not self.is_last:
            require(self.standing_m == 0.0, "standing_m is given; cars stand in the last section of a track alone")
            return
        require(self.track is not None, "track is missing; the last section of a track must tell the track's number")
        require(
            self.length_m == self.next.length_m,
            f"length_m is {self.length_m:g}; the last section of a track must be as long as its edge, "
            f"{self.next.length_m:g} m",
        )
        require(
            self.standing_m <= self.length_m,
            f"standing_m is {self.standing_m:g}; it must be at most the length of the section, {self.length_m:g} m",
        )

    @property
    def is_last(self) -> bool:
        """Whether the track ends in this section."""
        return self.next.to is None

    @property
    def edges(self) -> tuple[Edge, ...]:
        """The one edge."""
        return (self.next,)

    @property
    def section_m(self) -> tuple[float, float]:
        """Metres of the insulated section (ahead of the element, behind it)."""
        return 0.0, self.length_m
