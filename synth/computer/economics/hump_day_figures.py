"""The figures of a simulated or observed hump with their intervals, as they enter the economics."""

from __future__ import annotations

from dataclasses import dataclass

from synth.computer.economics.hump_rates import HumpRates
from synth.frame.interval import Interval
from synth.frame.settings.changed import made

NAMES = {
    "cars_per_h": "cars_per_hour",
    "catch_ups": "catch_ups",
    "misrouted": "misrouted",
    "over_speeds_to_1_5": "overspeed_slight",
    "over_speeds_to_2": "overspeed_rough",
    "over_speeds_above_2": "overspeed_harmful",
    "gap_m": "gap_per_cut",
}
"""Our figures, and what `hump simulate` calls them in `summary.json`."""


@dataclass(frozen=True)
class HumpDayFigures:
    """The figures of `HumpRates`, each with its interval; `name` of the variant; `on_track` has none and needs none."""

    name: str
    cars_per_h: Interval
    catch_ups: Interval
    misrouted: Interval
    on_track: float
    over_speeds_to_1_5: Interval
    over_speeds_to_2: Interval
    over_speeds_above_2: Interval
    gap_m: Interval

    def __post_init__(self) -> None:
        self.rates  # noqa: B018  # its ranges are checked where it is made

    @property
    def rates(self) -> HumpRates:
        """The figures without their intervals."""
        return made(HumpRates, on_track=self.on_track, **{name: getattr(self, name).value for name in NAMES})
