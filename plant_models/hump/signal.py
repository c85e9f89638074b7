"""A signal of the hump: at a crest, where routes begin, or between other elements."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models.hump.edge import Edge
from plant_models.hump.element_number import SIGNALS


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
