"""An insulated section of plain track: of a classification track, or between other elements."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models.errors import require
from plant_models.hump.edge import Edge
from plant_models.hump.element_number import SECTIONS
from plant_models.hump.ranges import LENGTH_M, STANDING_M, TRACK


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
