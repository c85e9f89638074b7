"""What the configuration of a control computer may contain; most of its tables are the values of the calculation.
With the usual figures of a hump, the amounts that a currency of its own leaves as they are, and a commented
configuration to start from.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, Literal

from pydantic import Field, model_validator

from plant_models.errors import require
from plant_models.library.hump_entry import hump_names
from plant_models.library.sourced_value import JUDGEMENT, SET_BY_USER
from synth.computer.economics.investment import Terms
from synth.computer.economics.traffic import Handling, HumpChange, HumpRates, Prices, Traffic
from synth.computer.origins import SPEED, STUDY
from synth.computer.reliability.upkeep import Upkeep
from synth.computer.sizing.carried_positions import PositionTimes
from synth.computer.sizing.service import Cycle, Service
from synth.computer.uncertainty import UncertaintySettings
from synth.frame.settings.numbers import Source, Title, numbers_of
from synth.frame.settings.section import OutputSettings, Section, choice, many, needed, optional, setting
from synth.frame.settings.template import template

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


class TaskSettings(Section):
    """Tasks that requests call up at random: a Poisson stream of them, each asking for a number of operations."""

    name: str = Field(min_length=1, max_length=80)
    rate_per_s: float = needed("1/s", 1e-9, 1e12, "requests a second", SPEED)
    operations: float = needed("1", 1e-9, 1e18, "mean number of operations of a request", SPEED)
    law: Literal["constant", "erlang", "exponential", "hyperexponential"] = choice("constant", "law of that number")
    stages: int | None = optional("1", 1, 1000, "of law erlang, which needs it", 4)
    squared_cv: float | None = optional("1", 1.0, 1e6, "above 1; of law hyperexponential, which needs it", 2.0)
    priority: int = setting(1, "1", 1, 1000, "1 is the most urgent")
    deadline_s: float | None = optional("s", 1e-9, 1e6, "when the service must have ended", 0.1)


USUAL_TASKS = (
    TaskSettings(
        name="control of cuts, with feedback", rate_per_s=0.825, operations=8000.0, priority=1, deadline_s=0.1
    ),
)
"""Rate and operations of [hump-computer-1970s], chapter 3; constant, because only that law keeps both of its waits."""


class RatesSettings(Section):
    """The hump with the control of today, and by how much more of it with the new one.

    Told by figures, or by two runs of 'hump simulate'; differences are paired where both humped the same trains.
    """

    today_trial: str | None = choice(None, "directory of the run with the control of today", "out/today")
    new_trial: str | None = choice(None, "directory of the run with the new control", "out/new")
    today: HumpRates = USUAL_TODAY
    change: HumpChange = USUAL_CHANGE

    @model_validator(mode="after")
    def _both_or_none(self) -> RatesSettings:
        require(
            (self.today_trial is None) == (self.new_trial is None),
            "today_trial and new_trial go together; give both or none",
        )
        return self


class AcceptanceSettings(Section):
    """Limits; exit code 1 if one is missed, or cannot be decided."""

    pay_back_years: float | None = optional("a", 0.001, 1000.0, "longest pay-back, in 95 of 100 draws", 4.0)
    loss_per_year: float | None = optional("currency/a", 0.0, 1e15, "highest loss by failures", 100_000.0)


class ComputerSettings(Section):
    """A whole configuration of a control computer; an empty one is the built-in default."""

    title: Title | None = choice(None, "title of the page", "…")
    hump: str = choice(
        "large", f"whose elements are counted: {', '.join(hump_names())}, or the path of your own hump file"
    )
    task: tuple[TaskSettings, ...] = many(USUAL_TASKS, 1, 50, "tables [[task]]")
    service: Service = Service()
    cycle: Cycle = Cycle()
    position: PositionTimes = PositionTimes()
    reliability: Upkeep = Upkeep()
    prices: Prices = Prices()
    traffic: Traffic = Traffic()
    handling: Handling = Handling()
    rates: RatesSettings = RatesSettings()
    terms: Terms = Terms()
    range: tuple[RangeSettings, ...] = many(USUAL_RANGES, 0, 100, "tables [[range]]")
    uncertainty: UncertaintySettings = UncertaintySettings()
    acceptance: AcceptanceSettings = AcceptanceSettings()
    output: OutputSettings = OutputSettings()


CURRENCY: Final = "currency"
"""Begins the unit of an amount."""


def unpriced(settings: ComputerSettings) -> Iterator[str]:
    """A sentence with the keys of all amounts that are not given, where the currency is another than the usual one."""
    usual, own = Prices.model_fields[CURRENCY].default, settings.prices.currency
    if own == usual:
        return
    amounts = [each.key for each in numbers_of(settings) if each.unit.startswith(CURRENCY)]
    missing = [key for key in amounts if not is_given(settings, key)]
    if "range" not in settings.model_fields_set:  # of a number that is given no usual range is taken
        missing += [f"[[range]] of {each.input}" for each in settings.range if each.input in missing]
    if missing:
        yield (
            f"prices.currency is {own!r}, but these amounts are not given and stay numbers of {usual}: "
            f"{', '.join(missing)}; give each of them in {own}"
        )


def is_given(settings: Section, key: str) -> bool:
    """Whether the file says the number under the dotted `key`."""
    name, _, rest = key.partition(".")
    if name not in settings.model_fields_set:
        return False
    inner = getattr(settings, name)
    return not rest or not isinstance(inner, Section) or is_given(inner, rest)


def default_computer_toml() -> str:
    """The defaults as TOML; it reads back to the same configuration."""
    return template(ComputerSettings(), "Control computer of a hump", "computer")
