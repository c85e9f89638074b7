"""Prices of what a hump uses, loses and holds."""

from __future__ import annotations

from dataclasses import dataclass, fields

from plant_models.errors import require, require_between

MOST = 1e15


@dataclass(frozen=True)
class Prices:
    """All in one `currency`, each at least 0 (`PlantError`).

    `per_locomotive_h`: an hour of the hump locomotive with its crew. `per_car_h`: an hour that a car stands in the
    yard, as running cost alone (upkeep, hire); what the car itself is worth is `per_car`, so that it is not counted
    twice. `per_cargo_t`: worth of a tonne of cargo. `per_over_speed_…`: mean damage of one coupling of this class of
    speed (up to 1.5 m/s, up to 2 m/s, faster), those that damage nothing included. `per_catch_up`: of a cut that
    caught up, damage and delay. `per_misrouted_cut`: of a cut on a wrong track, besides the locomotive that sorts it
    again. `per_gap_m`: of a metre of gap that is pushed up, besides the locomotive.
    """

    currency: str
    per_locomotive_h: float
    per_car_h: float
    per_car: float
    per_cargo_t: float
    per_over_speed_to_1_5: float
    per_over_speed_to_2: float
    per_over_speed_above_2: float
    per_catch_up: float
    per_misrouted_cut: float
    per_gap_m: float

    def __post_init__(self) -> None:
        require(bool(self.currency.strip()), "currency is empty; name the currency of all prices")
        for field in fields(self):
            if field.name != "currency":
                require_between(field.name, getattr(self, field.name), 0.0, MOST)
