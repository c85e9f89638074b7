"""Whether the grid of a design is to be believed: the same lines on it and on a finer one."""

from __future__ import annotations

from dataclasses import dataclass

LEAST_SHARE, MOST_SHARE = 0.8, 1.25
"""An rms on the grid of a design that is a smaller or a larger share of that on the finer grid is not believed."""


@dataclass(frozen=True)
class GridCheck:
    """Predicted rms of polished lines on the grid of their design, and on the finer one of the prediction.

    `again`: whether the design is a second one, on finer speeds, as the first was not believed.
    """

    design_rms_m_s: float
    finer_rms_m_s: float
    again: bool

    @property
    def share(self) -> float:
        """The first over the second; 1 where the second is 0."""
        return self.design_rms_m_s / self.finer_rms_m_s if self.finer_rms_m_s > 0.0 else 1.0

    @property
    def is_believed(self) -> bool:
        """Whether the two grids agree."""
        return LEAST_SHARE <= self.share <= MOST_SHARE
