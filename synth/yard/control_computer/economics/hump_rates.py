"""The figures of a hump as plain numbers, and how they change."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from plant_models.errors import require, require_between

MOST_CARS_PER_H = 1e5


@dataclass(frozen=True)
class HumpRates:
    """What a hump does with its cars.

    `cars_per_h`: while a train is humped. Shares of all cuts: `catch_ups` (misrouted or in contact ahead of the last
    position), `misrouted` among them, `on_track` (those that reached their track alone). Shares of the cuts on
    their track: `over_speeds_…`, couplings up to 1.5 m/s, up to 2 m/s and faster. `gap_m`: free metres that a cut on
    its track left ahead of it. `PlantError` for a value outside its range.
    """

    cars_per_h: float
    catch_ups: float
    misrouted: float
    on_track: float
    over_speeds_to_1_5: float
    over_speeds_to_2: float
    over_speeds_above_2: float
    gap_m: float

    def __post_init__(self) -> None:
        require(
            0.0 < self.cars_per_h <= MOST_CARS_PER_H,
            f"cars_per_h is {self.cars_per_h!r}; it must be above 0 and at most {MOST_CARS_PER_H:g}",
        )
        for name in SHARES:
            require_between(name, getattr(self, name), 0.0, 1.0)
        require_between("gap_m", self.gap_m, 0.0, 1e4)


SHARES = ("catch_ups", "misrouted", "on_track", "over_speeds_to_1_5", "over_speeds_to_2", "over_speeds_above_2")


@dataclass(frozen=True)
class HumpChange:
    """By how much each figure of `HumpRates` is larger with the new control; 0 where it is not told."""

    cars_per_h: float = 0.0
    catch_ups: float = 0.0
    misrouted: float = 0.0
    on_track: float = 0.0
    over_speeds_to_1_5: float = 0.0
    over_speeds_to_2: float = 0.0
    over_speeds_above_2: float = 0.0
    gap_m: float = 0.0

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            require(math.isfinite(value), f"the change of {field.name} is {value!r}; it must be a finite number")


def changed(today: HumpRates, change: HumpChange) -> HumpRates:
    """`today` plus `change`.

    Shares stay within 0 and 1 and gaps at 0 or more: a change that is drawn from its interval can take a rare share
    below nothing.
    """
    made = {field.name: getattr(today, field.name) + getattr(change, field.name) for field in fields(HumpRates)}
    for name in SHARES:
        made[name] = min(max(made[name], 0.0), 1.0)
    made["gap_m"] = max(made["gap_m"], 0.0)
    return HumpRates(**made)
