"""Uncertain inputs to what the computer costs and pays: reliability and economics as one function of named numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace

from plant_models.errors import require
from synth.yard.control_computer.economics.economic_case import (
    EconomicCase,
    EconomicResult,
    Terms,
    evaluated,
    with_inputs,
)
from synth.yard.control_computer.economics.hump_rates import HumpChange, HumpRates
from synth.yard.control_computer.economics.prices import Prices
from synth.yard.control_computer.economics.traffic import Handling, Traffic
from synth.yard.control_computer.reliability.upkeep import Upkeep

RELIABILITY = "reliability"
PARTS = {
    "prices": Prices, "traffic": Traffic, "handling": Handling, "today": HumpRates, "change": HumpChange,
    "terms": Terms, RELIABILITY: Upkeep,
}  # fmt: skip
WORDS = ("currency", "computers", "failed_check_to")


def require_input(key: str) -> None:
    """Raise `PlantError` unless `key` is a number that may be uncertain."""
    part, _, name = key.partition(".")
    require(part in PARTS, f"range: input is {key!r}; it must begin with one of {', '.join(f'{p}.' for p in PARTS)}")
    known = [field.name for field in fields(PARTS[part]) if field.name not in WORDS]
    require(name in known, f"range: input is {key!r}; {part} has {', '.join(known)}")


@dataclass(frozen=True)
class ComputerModel:
    """`case` with the losses by failures of `upkeep` among its running costs."""

    case: EconomicCase
    upkeep: Upkeep

    def result(self) -> EconomicResult:
        """The calculation; `PlantError` where the hump is overloaded."""
        terms = self.case.terms
        running = terms.running_cost_per_year + self.upkeep.loss_per_year()
        return evaluated(replace(self.case, terms=replace(terms, running_cost_per_year=running)))

    def changed(self, inputs: Mapping[str, float]) -> ComputerModel:
        """The same with some inputs changed, by their keys."""
        own = {key.partition(".")[2]: value for key, value in inputs.items() if key.startswith(f"{RELIABILITY}.")}
        others = {key: value for key, value in inputs.items() if not key.startswith(f"{RELIABILITY}.")}
        return ComputerModel(with_inputs(self.case, others), with_inputs(self.upkeep, own))

    def figures(self, inputs: Mapping[str, float]) -> dict[str, float]:
        """Named inputs to named outputs: losses by failures, and what the economic case gives."""
        changed = self.changed(inputs)
        return {"failure_loss_per_year": changed.upkeep.loss_per_year(), **changed.result().figures()}
