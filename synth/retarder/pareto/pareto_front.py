"""What less time in the position costs in accuracy, by the price of a second; nothing here needs a kernel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from synth.simulation.exit_statistics import ExitStatistics
from synth.simulation.replicates import Interval

PRICES_M2_S3: Final = (0.0, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3)
"""What a second costs, from nothing on."""

NEARLY_FREE: Final = 1.01
"""A price is nearly free that makes no rms larger by more than this factor, beyond its 95 % interval."""


@dataclass(frozen=True)
class ParetoPoint:
    """A table for one price of a second; `ratio`: its rms over that of the table for the lowest price, paired."""

    time_price_m2_s3: float
    statistics: ExitStatistics
    predicted_rms_m_s: float
    ratio: float
    ratio_ci95: Interval


@dataclass(frozen=True)
class ParetoFront:
    """The points of one case by rising price; prices for which no table can be made are left out."""

    label: str
    target_speed_m_s: float
    points: tuple[ParetoPoint, ...]

    @property
    def name(self) -> str:
        """'gondola-4-22t to 3 m/s'."""
        return f"{self.label} to {self.target_speed_m_s:g} m/s"

    def at(self, time_price_m2_s3: float) -> ParetoPoint | None:
        """The point of a price, if it has one."""
        return next((each for each in self.points if each.time_price_m2_s3 == time_price_m2_s3), None)

    def saved_s(self, point: ParetoPoint) -> float:
        """How much sooner cuts leave than at the lowest price, in the mean."""
        return self.points[0].statistics.time_s - point.statistics.time_s


def nearly_free(fronts: Sequence[ParetoFront]) -> float:
    """The highest price up to which each is nearly free; the lowest if none is."""
    free = PRICES_M2_S3[0]
    for price in PRICES_M2_S3:
        found = [point for front in fronts if (point := front.at(price)) is not None]
        if len(found) < len(fronts) or any(point.ratio_ci95[0] > NEARLY_FREE for point in found):
            break
        free = price
    return free


def told(fronts: Sequence[ParetoFront]) -> str:
    """What is nearly free, in a sentence."""
    price, more = nearly_free(fronts), f"{NEARLY_FREE - 1.0:.0%}"
    if price == PRICES_M2_S3[0]:
        return (
            f"Already a price of {PRICES_M2_S3[1]:g} m2/s3 on a second makes some rms more than {more} larger beyond "
            "its 95 % interval, or leaves a case without a table (criterion.time_price_m2_s3)."
        )
    change = [-front.saved_s(point) for front in fronts if (point := front.at(price)) is not None]
    return (
        f"A price of {price:g} m2/s3 on a second makes no rms more than {more} larger beyond its 95 % interval, and "
        f"changes the mean time in the position by {min(change):+.2f} to {max(change):+.2f} s "
        "(criterion.time_price_m2_s3)."
    )
