"""What the configuration of a control computer may contain; most of its tables are the values of the calculation."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator

from plant_models.errors import require
from plant_models.library.hump_entry import hump_names
from synth.computer.economics.hump_rates import HumpChange, HumpRates
from synth.computer.economics.prices import Prices
from synth.computer.economics.terms import Terms
from synth.computer.economics.traffic import Handling, Traffic
from synth.computer.origins import SPEED
from synth.computer.reliability.upkeep import Upkeep
from synth.computer.sizing.carried_positions import PositionTimes
from synth.computer.sizing.cyclic_service import Cycle
from synth.computer.sizing.demand_service import Service
from synth.computer.uncertainty import UncertaintySettings
from synth.computer.usual_money import USUAL_CHANGE, USUAL_RANGES, USUAL_TODAY, RangeSettings
from synth.frame.settings.output import OutputSettings
from synth.frame.settings.section import Section, choice, many, needed, optional, setting
from synth.frame.settings.value_forms import Title


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
