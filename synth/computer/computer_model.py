"""Uncertain inputs to what the computer costs and pays: reliability and economics as one function of named numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from plant_models.errors import require
from synth.computer.economics.economic_case import EconomicCase, EconomicResult, evaluated
from synth.computer.reliability.upkeep import Upkeep
from synth.frame.settings.changed import changed, with_inputs
from synth.frame.settings.section import Section, setting_unit

RELIABILITY = "reliability"


def require_input(key: str) -> None:
    """Raise `PlantError` unless `key` is a number that may be uncertain."""
    parts: dict[str, type[Section]] = {RELIABILITY: Upkeep}
    for name, declared in EconomicCase.model_fields.items():
        assert isinstance(declared.annotation, type), name
        parts[name] = declared.annotation
    part, _, name = key.partition(".")
    require(part in parts, f"range: input is {key!r}; it must begin with one of {', '.join(f'{p}.' for p in parts)}")
    known = [each for each, declared in parts[part].model_fields.items() if setting_unit(declared)]
    require(name in known, f"range: input is {key!r}; {part} has {', '.join(known)}")


@dataclass(frozen=True)
class ComputerModel:
    """`case` with the losses by failures of `upkeep` among its running costs."""

    case: EconomicCase
    upkeep: Upkeep

    def result(self) -> EconomicResult:
        """The calculation; `PlantError` where the hump is overloaded."""
        running = self.case.terms.running_cost_per_year + self.upkeep.loss_per_year()
        return evaluated(with_inputs(self.case, {"terms.running_cost_per_year": running}))

    def changed(self, inputs: Mapping[str, float]) -> ComputerModel:
        """The same with some inputs changed, by their keys; `PlantError` for a value that is not allowed."""
        own = {key.partition(".")[2]: value for key, value in inputs.items() if key.startswith(f"{RELIABILITY}.")}
        others = {key: value for key, value in inputs.items() if not key.startswith(f"{RELIABILITY}.")}
        return ComputerModel(with_inputs(self.case, others), changed(self.upkeep, **own))

    def figures(self, inputs: Mapping[str, float]) -> dict[str, float]:
        """Named inputs to named outputs: losses by failures, and what the economic case gives."""
        model = self.changed(inputs)
        return {"failure_loss_per_year": model.upkeep.loss_per_year(), **model.result().figures()}
