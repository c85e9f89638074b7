"""The usual figures of a hump, how they change, and how far the inputs of the economics are known."""

from __future__ import annotations

from typing import Final, Literal

from pydantic import Field, model_validator

from plant_models.errors import require
from plant_models.library.sourced_value import JUDGEMENT, SET_BY_USER
from synth.computer.economics.hump_rates import HumpChange, HumpRates
from synth.computer.origins import STUDY
from synth.frame.settings.section import Section, choice
from synth.frame.settings.value_forms import Source

USUAL_TODAY: Final = HumpRates(
    cars_per_h=587.8,
    catch_ups=0.00175,
    misrouted=0.00175,
    on_track=0.9949,
    over_speeds_to_1_5=0.03015,
    over_speeds_to_2=0.07321,
    over_speeds_above_2=0.01952,
    gap_m=72.88,
)
USUAL_CHANGE: Final = HumpChange(
    cars_per_h=138.7,
    catch_ups=-0.000625,
    misrouted=-0.000625,
    on_track=0.00275,
    over_speeds_to_1_5=0.002299,
    over_speeds_to_2=-0.0006961,
    over_speeds_above_2=0.0006966,
    gap_m=-14.81,
)
MEASURED_CHANGE: Final = {
    "cars_per_h": (134.9, 142.4),
    "catch_ups": (-0.001699, 0.0004486),
    "misrouted": (-0.001699, 0.0004486),
    "on_track": (0.0009412, 0.004559),
    "over_speeds_to_1_5": (-0.00273, 0.007328),
    "over_speeds_to_2": (-0.006948, 0.005556),
    "over_speeds_above_2": (-0.002669, 0.004062),
    "gap_m": (-15.76, -13.85),
}
"""Their 95 % intervals, paired by train."""


class RangeSettings(Section):
    """How far inputs are known: uniform from low to high, triangular with mode, lognormal with 5 and 95 % of it below
    low and high, or measured: the configured value with its 95 % interval. Those given here replace all."""

    input: str = Field(min_length=3, max_length=80, description='key of the input, as "prices.per_car_h"')
    law: Literal["uniform", "triangular", "lognormal", "measured"] = choice("lognormal", "its distribution")
    low: float = Field(description="see above", json_schema_extra={"unit": "as the input"})
    high: float = Field(description="see above", json_schema_extra={"unit": "as the input"})
    mode: float | None = Field(None, description="of law triangular", json_schema_extra={"unit": "as the input"})
    source: Source = choice(SET_BY_USER, "where the range is from")

    @model_validator(mode="after")
    def _mode_of_triangular(self) -> RangeSettings:
        require(
            (self.mode is not None) == (self.law == "triangular"),
            f"range of {self.input}: mode is for law = 'triangular', which needs it; the law is {self.law!r}",
        )
        return self


KNOWN: Final = f"{JUDGEMENT}: how far it is known"
LOGNORMAL: Final = {
    "prices.per_locomotive_h": (100.0, 400.0),
    "prices.per_car_h": (0.25, 1.0),
    "prices.per_car": (20_000.0, 80_000.0),
    "prices.per_over_speed_above_2": (75.0, 1200.0),
    "handling.locomotive_h_per_gap_m": (7e-5, 1.4e-4),
    "reliability.failure_per_h": (2e-4, 5e-3),
    "reliability.unnoticed_per_h": (1000.0, 10_000.0),
    "terms.investment": (600_000.0, 1_700_000.0),
}
EVEN: Final = {"traffic.cars_per_day": (3600.0, 4400.0), "terms.fixed_saving_per_year": (0.0, 300_000.0)}
USUAL_RANGES: Final = (
    *(RangeSettings(input=key, low=low, high=high, source=KNOWN) for key, (low, high) in LOGNORMAL.items()),
    *(RangeSettings(input=key, law="uniform", low=low, high=high, source=KNOWN) for key, (low, high) in EVEN.items()),
    *(
        RangeSettings(
            input=f"change.{key}", law="measured", low=low, high=high, source=f"{STUDY}: 95 % interval"
        )
        for key, (low, high) in MEASURED_CHANGE.items()
    ),
)  # fmt: skip
