"""What the new control saves: running costs a year (ΔE), and capital that it sets free (ΔK), item by item."""

from __future__ import annotations

from dataclasses import dataclass

from synth.computer.economics.hump_work import HOURS_PER_DAY, HumpWork
from synth.computer.economics.prices import Prices
from synth.computer.economics.traffic import Traffic


@dataclass(frozen=True)
class Item:
    """One saving: `quantity` in `unit` (a year, or set free once) times its mean `price` is `amount`, in the currency.

    A negative amount is a loss.
    """

    name: str
    quantity: float
    unit: str
    price: float

    @property
    def amount(self) -> float:
        """Money."""
        return self.quantity * self.price


def total(items: tuple[Item, ...]) -> float:
    """All amounts together."""
    return sum(item.amount for item in items)


def operating_savings(
    today: HumpWork, new: HumpWork, traffic: Traffic, prices: Prices, fixed_per_year: float = 0.0
) -> tuple[Item, ...]:
    """ΔE, a year, after the list of Mukha's method in [hump-computer-1970s], and damages, sorting again and gaps.

    `fixed_per_year`: what does not depend on the work of the hump (staff, energy). The source gives the list alone; the
    quantities are ours. Time of locomotives is priced by hour, wherever it is spent; no hour is counted twice.
    """
    days = traffic.days_per_year

    def saved(name: str, figure: str, unit: str, price: float) -> Item:
        return Item(name, days * (getattr(today, figure) - getattr(new, figure)), unit, price)

    hour = prices.per_locomotive_h
    return (
        Item("what does not depend on the work of the hump", 1.0, "year", fixed_per_year),
        saved("cars: shorter humping", "car_h_humping", "car h", prices.per_car_h),
        saved("cars: shorter wait for humping", "car_h_waiting", "car h", prices.per_car_h),
        saved("locomotive: shorter humping", "locomotive_h_humping", "locomotive h", hour),
        saved("locomotive: gaps pushed up", "locomotive_h_pushing_up", "locomotive h", hour),
        saved("locomotive: cuts sorted again", "locomotive_h_sorting_again", "locomotive h", hour),
        saved("damage: couplings to 1.5 m/s", "over_speeds_to_1_5", "couplings", prices.per_over_speed_to_1_5),
        saved("damage: couplings to 2 m/s", "over_speeds_to_2", "couplings", prices.per_over_speed_to_2),
        saved("damage: couplings above 2 m/s", "over_speeds_above_2", "couplings", prices.per_over_speed_above_2),
        saved("catch-ups", "catch_ups", "cuts", prices.per_catch_up),
        saved("cuts sorted again, besides the locomotive", "misrouted", "cuts", prices.per_misrouted_cut),
        saved("gaps pushed up, besides the locomotive", "gap_m", "m", prices.per_gap_m),
    )


def released_capital(today: HumpWork, new: HumpWork, traffic: Traffic, prices: Prices) -> tuple[Item, ...]:
    """ΔK, once: cars that are no longer needed, and the cargo in them.

    Cars in the yard = N·Δt/24 with N cars a day and Δt hours less for each (Little's law): the car hours of a day / 24.
    Cargo in transit: the same cars × share of loaded ones × load × worth of a tonne.
    """
    cars = (today.car_h - new.car_h) / HOURS_PER_DAY
    return (
        Item("released cars", cars, "cars", prices.per_car),
        Item("cargo in transit", cars * traffic.loaded_share * traffic.load_t, "t", prices.per_cargo_t),
    )
