"""A simulated or measured figure: its value, and how far chance leaves it open."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from plant_models.errors import require

ROUNDING: Final = 1e-12
"""Of a figure: what a mean of equal numbers may be off by."""


@dataclass(frozen=True)
class Interval:
    """`value` with its 95 % interval from `low95` to `high95`, told from `n` passes, trains, cuts or draws.

    Infinite is what never comes. `PlantError` for ends that do not hold the value, and for an `n` below 1.
    """

    value: float
    low95: float
    high95: float
    n: int

    def __post_init__(self) -> None:
        require(
            self.low95 <= self.value <= self.high95,
            f"the figure {self.value!r} has the interval from {self.low95!r} to {self.high95!r}; both ends must be "
            "numbers and hold the figure",
        )
        require(self.n >= 1, f"n is {self.n!r}; a figure is told from 1 or more")

    @property
    def half_width(self) -> float:
        """The wider half."""
        return max(self.high95 - self.value, self.value - self.low95)

    @property
    def is_told_by_half(self) -> bool:
        """Whether value ± `half_width` is fair: not rounding alone, and across zero only where the interval is."""
        half = self.half_width
        across = self.low95 < 0.0 < self.high95 or not abs(self.value) < half
        return across and half > ROUNDING * abs(self.value)
