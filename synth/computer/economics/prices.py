"""Prices of what a hump uses, loses and holds."""

from __future__ import annotations

from pydantic import Field

from synth.computer.origins import USUAL
from synth.frame.settings.section import Section, setting


class Prices(Section):
    """Prices, all in one currency. A damage is the mean over all such couplings, those that damage nothing included."""

    currency: str = Field("EUR", min_length=1, max_length=12, pattern=r"\S", description="of all amounts")
    per_locomotive_h: float = setting(200.0, "currency/h", 0.0, 1e9, "hump locomotive with its crew", USUAL)
    per_car_h: float = setting(
        0.5, "currency/h", 0.0, 1e9, "hire and upkeep of a car in the yard, without what the car is worth", USUAL
    )
    per_car: float = setting(40_000.0, "currency", 0.0, 1e12, "worth of a car", USUAL)
    per_cargo_t: float = setting(600.0, "currency/t", 0.0, 1e9, "worth of cargo", USUAL)
    per_over_speed_to_1_5: float = setting(
        2.0, "currency", 0.0, 1e9, "mean damage of a coupling at 1.39 to 1.5 m/s", USUAL
    )
    per_over_speed_to_2: float = setting(20.0, "currency", 0.0, 1e9, "the same at 1.5 to 2 m/s", USUAL)
    per_over_speed_above_2: float = setting(300.0, "currency", 0.0, 1e9, "the same above 2 m/s", USUAL)
    per_catch_up: float = setting(50.0, "currency", 0.0, 1e9, "damage and delay of a cut that caught up", USUAL)
    per_misrouted_cut: float = setting(
        30.0, "currency", 0.0, 1e9, "paper work of a cut on a wrong track, besides the locomotive", USUAL
    )
    per_gap_m: float = setting(
        0.01, "currency/m", 0.0, 1e6, "metre of gap that is pushed up, besides the locomotive", USUAL
    )
