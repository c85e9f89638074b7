"""Tasks, the figures of the hump, and uncertain inputs, as a configuration asks for them: reliability and
economics as one function of named numbers.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from plant_models.errors import require
from synth.computer.economics.economic_case import EconomicCase, EconomicResult, evaluated
from synth.computer.economics.ranges import LogNormal, Measured, Range, Triangular, Uniform
from synth.computer.economics.traffic import HumpChange, HumpRates
from synth.computer.reliability.upkeep import Upkeep
from synth.computer.settings import (
    USUAL_CHANGE,
    USUAL_RANGES,
    ComputerSettings,
    RangeSettings,
    RatesSettings,
    TaskSettings,
    is_given,
)
from synth.computer.sizing.task import Constant, Erlang, Exponential, Hyperexponential, ServiceLaw, Task, TaskMix
from synth.frame.settings.section import Section, setting_unit
from synth.frame.settings.settings_file import changed, with_inputs

if TYPE_CHECKING:
    from synth.frame.interval import Interval


def asked_mix(tasks: tuple[TaskSettings, ...]) -> TaskMix:
    """The tasks; `PlantError` names the one at fault."""
    return TaskMix(
        tuple(Task(each.name, each.rate_per_s, law_of(each), each.priority, each.deadline_s) for each in tasks)
    )


def law_of(task: TaskSettings) -> ServiceLaw:
    """The law of the operations of a task."""
    require(
        (task.stages is not None) == (task.law == "erlang"),
        f"task {task.name}: stages is for law = 'erlang', which needs it; the law is {task.law!r}",
    )
    require(
        (task.squared_cv is not None) == (task.law == "hyperexponential"),
        f"task {task.name}: squared_cv is for law = 'hyperexponential', which needs it; the law is {task.law!r}",
    )
    if task.stages is not None:
        return Erlang(task.operations, task.stages)
    if task.squared_cv is not None:
        return Hyperexponential(task.operations, task.squared_cv)
    return Constant(task.operations) if task.law == "constant" else Exponential(task.operations)


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


@dataclass(frozen=True)
class HumpFigures:
    """The figures of the hump today and their change; `found`: where that was simulated, with intervals.

    `sha256`: of the trains that it was told from, by their place in the configuration; `reads`: their files.
    """

    today: HumpRates
    change: HumpChange
    found: Mapping[str, Interval] | None = None
    sha256: Mapping[str, str] = field(default_factory=dict)
    reads: tuple[Path, ...] = ()


def figure_sources(rates: RatesSettings, folder: Path, place: str) -> HumpFigures:
    """The figures as told, or from two directories of `hump simulate`; `InputError`."""
    if rates.today_trial is None or rates.new_trial is None:
        return HumpFigures(rates.today, rates.change)
    # Whoever tells figures needs nothing of how trains are humped.
    from synth.computer.economics.hump_day_change import (
        change_of,
        change_of_figures,
        change_of_trains,
        figures_of_trains,
        rates_of,
    )
    from synth.hump.trains.outcome_file import TRAINS, stored_trains

    folders = {"today_trial": folder / rates.today_trial, "new_trial": folder / rates.new_trial}
    stored = {key: stored_trains(each, f"{place}: rates.{key} is {str(each)!r}") for key, each in folders.items()}
    today, new = stored["today_trial"].found, stored["new_trial"].found
    figures = figures_of_trains(today)
    same = len(today) == len(new) and bool((today.train == new.train).all() and (today.cuts == new.cuts).all())
    found = change_of_trains(today, new) if same else change_of_figures(figures, figures_of_trains(new))
    return HumpFigures(
        today=rates_of(figures),
        change=change_of(found),
        found=found,
        sha256={key: hashlib.sha256(each.content).hexdigest() for key, each in stored.items()},
        reads=tuple(each / TRAINS for each in folders.values()),
    )


def asked_case(settings: ComputerSettings, figures: HumpFigures) -> EconomicCase:
    """All inputs of the economic calculation."""
    return EconomicCase(
        prices=settings.prices,
        traffic=settings.traffic,
        handling=settings.handling,
        today=figures.today,
        change=figures.change,
        terms=settings.terms,
    )


def asked_ranges(settings: ComputerSettings, figures: HumpFigures) -> dict[str, Range]:
    """Uncertain inputs by key; those of simulated differences are within their intervals. `PlantError`.

    A number that the configuration gives, without any range, is certain.
    """
    made: dict[str, Range] = {}
    if figures.found is not None:
        from synth.computer.economics.hump_day_change import ranges_of_change

        made = ranges_of_change(figures.found)
    told: set[str] = set()
    own_change = settings.rates.change != USUAL_CHANGE  # the intervals of the defaults are not those of other changes
    for each in settings.range:
        if own_change and each in USUAL_RANGES and each.law == "measured":
            continue
        if "range" not in settings.model_fields_set and is_given(settings, each.input):
            continue  # the usual range is about the usual value
        require(each.input not in told, f"range: {each.input!r} is given twice")
        require_input(each.input)
        told.add(each.input)
        if not (figures.found is not None and each.input.startswith("change.")):
            made[each.input] = range_law(each, settings, figures)
    return made


def range_law(each: RangeSettings, settings: ComputerSettings, figures: HumpFigures) -> Range:
    """The distribution of one input; `PlantError` names it."""
    if each.mode is not None:
        return Triangular(each.low, each.mode, each.high)
    if each.law == "measured":
        return Measured(value_of(each.input, settings, figures), each.low, each.high)
    return LogNormal(each.low, each.high) if each.law == "lognormal" else Uniform(each.low, each.high)


def value_of(key: str, settings: ComputerSettings, figures: HumpFigures) -> float:
    """The configured value of an input."""
    section, _, name = key.partition(".")
    held = {"today": figures.today, "change": figures.change}.get(section, getattr(settings, section, None))
    return float(getattr(held, name))
