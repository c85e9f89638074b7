"""Every number that the results of a control computer depend on, with unit, range and origin."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from typing import TYPE_CHECKING

from plant_models.library import SourcedValue
from plant_models.library.sourced_value import JUDGEMENT, SET_BY_USER
from synth.configuration.computer.money_settings import STUDY, USUAL_CHANGE, USUAL_TODAY, usual_ranges
from synth.configuration.computer.settings import USUAL_TASKS, ComputerSettings
from synth.configuration.resolved_config import setting_values

if TYPE_CHECKING:
    from synth.yard.control_computer.asked_money import HumpFigures

SECTIONS = (
    "service", "cycle", "position", "reliability", "prices", "traffic", "handling", "terms", "uncertainty",
)  # fmt: skip
TASK_SOURCE = "[hump-computer-1970s], chapter 3"


def computer_numbers(settings: ComputerSettings, figures: HumpFigures) -> Iterator[SourcedValue]:
    """All of them, in the order of the configuration."""
    yield from task_values(settings)
    for name in SECTIONS:
        yield from setting_values(name, getattr(settings, name))
    yield from figure_values(settings, figures)
    yield from range_values(settings)
    for key, limit in settings.acceptance.model_dump(exclude_none=True).items():
        yield SourcedValue(f"acceptance.{key}", limit, "", None, SET_BY_USER, "")


def task_values(settings: ComputerSettings) -> Iterator[SourcedValue]:
    """Rates and operations of the tasks."""
    source = TASK_SOURCE if settings.task == USUAL_TASKS else SET_BY_USER
    for task in settings.task:
        numbers = (("rate_per_s", task.rate_per_s, "1/s"), ("operations", task.operations, "1"),
                   ("deadline_s", task.deadline_s, "s"), ("stages", task.stages, "1"),
                   ("squared_cv", task.squared_cv, "1"), ("priority", task.priority, "1"))  # fmt: skip
        for key, value, unit in numbers:
            if value is not None:
                yield SourcedValue(f"task.{task.name}.{key}", float(value), unit, None, source, "")


def figure_values(settings: ComputerSettings, figures: HumpFigures) -> Iterator[SourcedValue]:
    """The figures of the hump today, and their change."""
    usual = settings.rates.today == USUAL_TODAY and settings.rates.change == USUAL_CHANGE
    told = f"{STUDY}, hump `large` of the library" if usual else SET_BY_USER
    source = "trials of 'hump simulate'" if figures.found is not None else told
    for name, values in (("today", asdict(figures.today)), ("change", asdict(figures.change))):
        for key, value in values.items():
            yield SourcedValue(f"rates.{name}.{key}", value, unit_of(key), None, source, "")


def unit_of(key: str) -> str:
    """Of a figure of the hump."""
    return {"cars_per_h": "1/h", "gap_m": "m"}.get(key, "1")


def range_values(settings: ComputerSettings) -> Iterator[SourcedValue]:
    """Ends of the ranges."""
    usual = usual_ranges()
    for each in settings.range:
        source = f"{JUDGEMENT}: how far it is known" if each in usual else SET_BY_USER
        measured = f"{STUDY}: 95 % interval" if each in usual and each.law == "measured" else source
        ends = (each.low, each.high) if each.mode is None else (each.low, each.mode, each.high)
        yield SourcedValue(f"range.{each.input}", ends, each.law, None, measured, "")
