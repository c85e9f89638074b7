"""A measured figure with its 95 % interval."""

from __future__ import annotations

import math
from dataclasses import dataclass

from plant_models.errors import require

NORMAL_95 = 1.959963984540054
"""97.5 % quantile of the normal law."""


@dataclass(frozen=True)
class Estimate:
    """`value` with its 95 % interval from `low95` to `high95`, told from `n` trains, cuts or draws.

    `PlantError` for an end that is no number, for ends in the wrong order, and for a value outside its interval.
    """

    value: float
    low95: float
    high95: float
    n: int

    def __post_init__(self) -> None:
        require(
            math.isfinite(self.low95) and math.isfinite(self.high95) and self.low95 <= self.value <= self.high95,
            f"the figure {self.value!r} has the interval from {self.low95!r} to {self.high95!r}; "
            "both ends must be finite and hold the figure",
        )
        require(self.n >= 1, f"n is {self.n!r}; a figure is told from 1 or more")
