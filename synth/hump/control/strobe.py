"""Strobing: a computed speed is compared with the greatest and the least that is possible ([hump-computer-1970s])."""

from __future__ import annotations

import math
from dataclasses import dataclass

from plant_models.errors import require, require_between


@dataclass(frozen=True)
class Strobe:
    """The least and the greatest possible speed, m/s."""

    least_m_s: float = 0.5
    greatest_m_s: float = 8.5

    def __post_init__(self) -> None:
        require_between("strobe: least_m_s", self.least_m_s, 0.0, 20.0)
        require_between("strobe: greatest_m_s", self.greatest_m_s, 0.0, 20.0)
        require(
            self.least_m_s < self.greatest_m_s,
            f"strobe: least_m_s is {self.least_m_s:g}; it must be less than greatest_m_s, {self.greatest_m_s:g}",
        )

    def holds(self, speed_m_s: float) -> bool:
        """Whether `speed_m_s` is possible; NaN and infinity are not."""
        return math.isfinite(speed_m_s) and self.least_m_s <= speed_m_s <= self.greatest_m_s

    def bounded(self, speed_m_s: float) -> float:
        """The possible speed next to `speed_m_s`; the least where it is no number, since a slow cut does the least
        harm."""
        if math.isnan(speed_m_s):
            return self.least_m_s
        return min(max(speed_m_s, self.least_m_s), self.greatest_m_s)
