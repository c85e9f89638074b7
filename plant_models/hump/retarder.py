"""A retarder of the hump: where it brakes, which position of the library it is, and what controls it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from plant_models.errors import require_none
from plant_models.hump.edge import Edge
from plant_models.hump.element_number import RETARDERS
from plant_models.hump.ranges import ENTRY_JOINT_M, EXIT_STD_M_S, RETARDER_EXIT_JOINT_M, ZONE_M


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
