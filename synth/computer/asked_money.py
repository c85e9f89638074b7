"""The figures of the hump as a configuration asks for them, and how far the inputs of the economics are known."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from plant_models.errors import require
from synth.computer.computer_model import require_input
from synth.computer.economics.economic_case import EconomicCase
from synth.computer.economics.hump_rates import HumpChange, HumpRates
from synth.computer.economics.uncertainty.ranges import LogNormal, Measured, Range, Triangular, Uniform
from synth.computer.settings import ComputerSettings, RatesSettings
from synth.computer.unpriced import is_given
from synth.computer.usual_money import USUAL_CHANGE, USUAL_RANGES, RangeSettings

if TYPE_CHECKING:
    from synth.frame.interval import Interval


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
    from synth.hump.trains.outcome_file import TRAINS
    from synth.hump.trains.stored_trains import stored_trains

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
