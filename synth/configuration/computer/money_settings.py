"""What the configuration of a control computer may contain of money: prices, traffic, the hump with it and without."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from plant_models.library.sourced_value import JUDGEMENT
from synth.configuration.section import Section, setting

USUAL = f"{JUDGEMENT}: its order of magnitude"
MUKHA = "[hump-computer-1970s], chapter 4"
STUDY = "study control-computer"


class PriceSettings(Section):
    """Prices, all in one currency."""

    currency: str = Field("EUR", min_length=1, max_length=12)
    per_locomotive_h: float = setting(200.0, "currency/h", 0.0, 1e9, "hump locomotive with its crew", USUAL)
    per_car_h: float = setting(0.5, "currency/h", 0.0, 1e9, "hire and upkeep of a car in the yard", USUAL)
    per_car: float = setting(40_000.0, "currency", 0.0, 1e12, "worth of a car", USUAL)
    per_cargo_t: float = setting(600.0, "currency/t", 0.0, 1e9, "worth of cargo", USUAL)
    per_over_speed_to_1_5: float = setting(
        2.0, "currency", 0.0, 1e9, "mean damage of a coupling at 1.39 to 1.5 m/s", USUAL
    )
    per_over_speed_to_2: float = setting(20.0, "currency", 0.0, 1e9, "the same at 1.5 to 2 m/s", USUAL)
    per_over_speed_above_2: float = setting(300.0, "currency", 0.0, 1e9, "the same above 2 m/s", USUAL)
    per_catch_up: float = setting(50.0, "currency", 0.0, 1e9, "damage and delay of a cut that caught up", USUAL)
    per_misrouted_cut: float = setting(30.0, "currency", 0.0, 1e9, "paper work of a cut on a wrong track", USUAL)
    per_gap_m: float = setting(0.01, "currency/m", 0.0, 1e6, "metre of gap, besides the locomotive", USUAL)


class TrafficSettings(Section):
    """Cars that are humped, and the trains that bring them."""

    cars_per_day: float = setting(4000.0, "1/d", 1.0, 1e6, "cars humped a day", f"{JUDGEMENT}: a large yard")
    cars_per_train: float = setting(72.0, "1", 1.0, 1000.0, "mean cars of a train", USUAL)
    cars_per_train_std: float = setting(12.0, "1", 0.0, 1000.0, "their standard deviation", USUAL)
    cars_per_cut: float = setting(1.8, "1", 1.0, 100.0, "mean cars of a cut", "as hump trials have it")
    arrival_scv: float = setting(
        1.0, "1", 0.0, 100.0, "squared coefficient of variation of times between trains", f"{JUDGEMENT}: as by chance"
    )
    loaded_share: float = setting(0.6, "1", 0.0, 1.0, "share of loaded cars", USUAL)
    load_t: float = setting(50.0, "t", 0.0, 1000.0, "mean load of those", USUAL)
    leads: int = setting(1, "1", 1, 10, "trains humped at the same time, each on a lead", USUAL)


class HandlingSettings(Section):
    """What the yard does around the humping of a train."""

    between_trains_h: float = setting(0.1, "h", 0.0, 24.0, "from the last cut of a train to the next train", USUAL)
    between_trains_std_h: float = setting(0.03, "h", 0.0, 24.0, "its standard deviation", USUAL)
    locomotive_h_per_gap_m: float = setting(
        1e-4, "h/m", 0.0, 1.0, "locomotive hours to push up a metre of gap", f"{JUDGEMENT}: many gaps in one trip"
    )
    locomotive_h_per_misrouted_cut: float = setting(0.25, "h", 0.0, 240.0, "to sort a cut again", USUAL)
    blocked_share: float = setting(0.3, "1", 0.0, 1.0, "of both, during which nothing can be humped", USUAL)


class FigureSettings(Section):
    """The figures of a hump, or their changes."""

    cars_per_h: float = 0.0
    catch_ups: float = 0.0
    misrouted: float = 0.0
    on_track: float = 0.0
    over_speeds_to_1_5: float = 0.0
    over_speeds_to_2: float = 0.0
    over_speeds_above_2: float = 0.0
    gap_m: float = 0.0


USUAL_TODAY = FigureSettings(
    cars_per_h=587.8,
    catch_ups=0.00175,
    misrouted=0.00175,
    on_track=0.9931,
    over_speeds_to_1_5=0.02929,
    over_speeds_to_2=0.07393,
    over_speeds_above_2=0.01997,
    gap_m=76.97,
)
USUAL_CHANGE = FigureSettings(
    cars_per_h=138.7,
    catch_ups=-0.000625,
    misrouted=-0.000625,
    on_track=0.00475,
    over_speeds_to_1_5=0.004751,
    over_speeds_to_2=-0.0005895,
    over_speeds_above_2=0.0005307,
    gap_m=-14.36,
)
MEASURED_CHANGE: dict[str, tuple[float, float]] = {
    "cars_per_h": (134.9, 142.4),
    "catch_ups": (-0.001699, 0.0004486),
    "misrouted": (-0.001699, 0.0004486),
    "on_track": (0.002761, 0.006739),
    "over_speeds_to_1_5": (-0.0003324, 0.009835),
    "over_speeds_to_2": (-0.006988, 0.005809),
    "over_speeds_above_2": (-0.00277, 0.003831),
    "gap_m": (-15.3, -13.42),
}
"""Their 95 % intervals, paired by train."""


class RatesSettings(Section):
    """What the hump does with its cars `today`, and by how much more of it with the new control (`change`).

    Or from directories that `hump simulate` left: `today_trial`, `new_trial`; differences are paired where both humped
    the same trains.
    """

    today: FigureSettings = USUAL_TODAY
    change: FigureSettings = USUAL_CHANGE
    today_trial: str | None = None
    new_trial: str | None = None


class TermsSettings(Section):
    """What the new control costs, and by which terms it is judged."""

    investment: float = setting(1_000_000.0, "currency", -1e15, 1e15, "what it costs more than what it replaces", USUAL)
    running_cost_per_year: float = setting(
        100_000.0, "currency/a", -1e15, 1e15, "upkeep more than today, losses by failures left out", USUAL
    )
    fixed_saving_per_year: float = setting(
        150_000.0, "currency/a", -1e15, 1e15, "what is saved whatever the traffic", f"{JUDGEMENT}: staff"
    )
    normative_efficiency_per_year: float = setting(
        0.12, "1/a", 0.0, 1.0, "yearly worth of released capital", f"{MUKHA}: 0.12 to 0.15"
    )
    discount_per_year: float = setting(0.05, "1/a", 0.0, 1.0, "discount of later money", USUAL)
    years: int = setting(15, "a", 1, 200, "life of the computer", USUAL)
    cashed_share: float = setting(0.0, "1", 0.0, 1.0, "part of the released capital that is sold", f"{JUDGEMENT}: none")
    interest_per_year: float = setting(0.25, "1/a", 0.0, 1.0, "simple interest of the pay-back formula", MUKHA)


class RangeSettings(Section):
    """How far an input is known: `input` is its key, as "prices.per_car_h".

    uniform from `low` to `high`; triangular with `mode`; lognormal with 5 and 95 % of it below `low` and `high`;
    measured: the configured value with its 95 % interval from `low` to `high`.
    """

    input: str = Field(min_length=3, max_length=80)
    law: Literal["uniform", "triangular", "lognormal", "measured"] = "lognormal"
    low: float
    high: float
    mode: float | None = None


def usual_ranges() -> tuple[RangeSettings, ...]:
    """Ranges of the defaults: judgement, all of them."""
    lognormal = {
        "prices.per_locomotive_h": (100.0, 400.0),
        "prices.per_car_h": (0.25, 1.0),
        "prices.per_car": (20_000.0, 80_000.0),
        "prices.per_over_speed_above_2": (75.0, 1200.0),
        "handling.locomotive_h_per_gap_m": (7e-5, 1.4e-4),
        "reliability.failure_per_h": (2e-4, 5e-3),
        "reliability.unnoticed_per_h": (1000.0, 10_000.0),
        "terms.investment": (600_000.0, 1_700_000.0),
    }
    uniform = {"traffic.cars_per_day": (3600.0, 4400.0), "terms.fixed_saving_per_year": (0.0, 300_000.0)}
    return (
        *(RangeSettings(input=key, low=low, high=high) for key, (low, high) in lognormal.items()),
        *(RangeSettings(input=key, law="uniform", low=low, high=high) for key, (low, high) in uniform.items()),
        *(
            RangeSettings(input=f"change.{key}", law="measured", low=low, high=high)
            for key, (low, high) in MEASURED_CHANGE.items()
            if low < high
        ),
    )
