"""Whether the grid of a design is to be believed: the same lines on it and without it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class GridCheck:
    """The rms of polished lines on the grid of their design, and what an independent computation says of it.

    `again`: whether the design is a second one, on finer speeds, as the first was not believed. `most_off`: factor
    between the two, either way, beyond which the grid is not believed.
    """

    design_rms_m_s: float
    independent_rms_m_s: float
    again: bool
    most_off: float

    @property
    def share(self) -> float:
        """The first over the second; 1 where the second is 0."""
        return self.design_rms_m_s / self.independent_rms_m_s if self.independent_rms_m_s > 0.0 else 1.0

    @property
    def is_believed(self) -> bool:
        """Whether the two agree."""
        return 1.0 / self.most_off <= self.share <= self.most_off
