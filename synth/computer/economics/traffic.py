"""The inputs of the calculation: the traffic of a hump and how the yard handles it, prices, and the figures of a
hump as plain numbers, with how they change.
"""

from __future__ import annotations

from typing import Final

from pydantic import Field, model_validator

from plant_models.errors import require
from plant_models.library.sourced_value import JUDGEMENT
from synth.computer.origins import STUDY, USUAL
from synth.frame.settings.section import Section, needed, setting
from synth.frame.settings.settings_file import changed


class Traffic(Section):
    """Cars that are humped, and the trains that bring them."""

    cars_per_day: float = setting(4000.0, "1/d", 1.0, 1e6, "cars humped a day", f"{JUDGEMENT}: a large yard")
    cars_per_train: float = setting(72.0, "1", 1.0, 1000.0, "mean cars of a train", USUAL)
    cars_per_train_std: float = setting(12.0, "1", 0.0, 1000.0, "their standard deviation", USUAL)
    cars_per_cut: float = setting(1.8, "1", 1.0, 100.0, "mean cars of a cut", "as hump trials have it")
    arrival_scv: float = setting(
        1.0, "1", 0.0, 100.0, "squared coefficient of variation of times between trains: 1 is Poisson, 0 a timetable",
        f"{JUDGEMENT}: as by chance",
    )  # fmt: skip
    loaded_share: float = setting(0.6, "1", 0.0, 1.0, "share of loaded cars", USUAL)
    load_t: float = setting(50.0, "t", 0.0, 1000.0, "mean load of those", USUAL)
    leads: int = setting(1, "1", 1, 10, "trains humped at the same time, each on a lead", USUAL)
    days_per_year: float = setting(365.0, "d", 1.0, 366.0, "days of humping in a year", USUAL)

    @model_validator(mode="after")
    def _cut_within_train(self) -> Traffic:
        require(
            self.cars_per_cut <= self.cars_per_train,
            f"cars_per_cut is {self.cars_per_cut:g}; it must be from 1 to cars_per_train, {self.cars_per_train:g}",
        )
        return self

    @property
    def trains_per_day(self) -> float:
        """Trains humped a day."""
        return self.cars_per_day / self.cars_per_train

    @property
    def cuts_per_day(self) -> float:
        """Cuts humped a day."""
        return self.cars_per_day / self.cars_per_cut

    @property
    def squared_cars_per_train(self) -> float:
        """E[n²] of the cars n of a train."""
        return self.cars_per_train**2 + self.cars_per_train_std**2


class Handling(Section):
    """What the yard does around the humping of a train."""

    between_trains_h: float = setting(
        0.1, "h", 0.0, 24.0, "mean time from the last cut of a train to the first of the next one that waits", USUAL
    )
    between_trains_std_h: float = setting(0.03, "h", 0.0, 24.0, "its standard deviation", USUAL)
    locomotive_h_per_gap_m: float = setting(
        1e-4, "h/m", 0.0, 1.0, "locomotive hours to push up a metre of gap", f"{JUDGEMENT}: many gaps in one trip"
    )
    locomotive_h_per_misrouted_cut: float = setting(
        0.25, "h", 0.0, 240.0, "to fetch a cut from a wrong track and sort it again", USUAL
    )
    blocked_share: float = setting(0.3, "1", 0.0, 1.0, "of both, in which nothing can be humped on this lead", USUAL)


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


SHARES: Final = ("catch_ups", "misrouted", "on_track", "over_speeds_to_1_5", "over_speeds_to_2", "over_speeds_above_2")


class HumpRates(Section):
    """What a hump does with its cars."""

    cars_per_h: float = needed("1/h", 1e-6, 1e5, "cars an hour while a train is humped", STUDY)
    catch_ups: float = needed("1", 0.0, 1.0, "of all cuts: misrouted, or in contact ahead of the last position", STUDY)
    misrouted: float = needed("1", 0.0, 1.0, "of all cuts: on a wrong track", STUDY)
    on_track: float = needed("1", 0.0, 1.0, "of all cuts: those that reached their track alone", STUDY)
    over_speeds_to_1_5: float = needed("1", 0.0, 1.0, "of these: couplings at 1.39 to 1.5 m/s", STUDY)
    over_speeds_to_2: float = needed("1", 0.0, 1.0, "of these: couplings at 1.5 to 2 m/s", STUDY)
    over_speeds_above_2: float = needed("1", 0.0, 1.0, "of these: couplings above 2 m/s", STUDY)
    gap_m: float = needed("m", 0.0, 1e4, "free metres that a cut on its track leaves ahead of it", STUDY)


class HumpChange(Section):
    """By how much each figure is larger with the new control; 0 where it is not told."""

    cars_per_h: float = setting(0.0, "1/h", -1e5, 1e5, "cars an hour while a train is humped", STUDY)
    catch_ups: float = setting(0.0, "1", -1.0, 1.0, "of all cuts", STUDY)
    misrouted: float = setting(0.0, "1", -1.0, 1.0, "of all cuts", STUDY)
    on_track: float = setting(0.0, "1", -1.0, 1.0, "of all cuts", STUDY)
    over_speeds_to_1_5: float = setting(0.0, "1", -1.0, 1.0, "of the cuts on their track", STUDY)
    over_speeds_to_2: float = setting(0.0, "1", -1.0, 1.0, "of the cuts on their track", STUDY)
    over_speeds_above_2: float = setting(0.0, "1", -1.0, 1.0, "of the cuts on their track", STUDY)
    gap_m: float = setting(0.0, "m", -1e4, 1e4, "free metres a cut", STUDY)


RATES: Final = tuple(HumpRates.model_fields)
"""The names of the figures, in their order."""


def rates_after(today: HumpRates, change: HumpChange) -> HumpRates:
    """`today` plus `change`; `PlantError` where no car an hour is left.

    Shares stay within 0 and 1 and gaps at 0 or more: a change that is drawn from its interval can take a rare share
    below nothing.
    """
    made = {name: getattr(today, name) + getattr(change, name) for name in RATES}
    for name in SHARES:
        made[name] = min(max(made[name], 0.0), 1.0)
    made["gap_m"] = max(made["gap_m"], 0.0)
    return changed(today, **made)
