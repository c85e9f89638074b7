"""Prices, traffic and the figures of the hump as a configuration asks for them, and how far they are known."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from plant_models.errors import require
from synth.configuration.computer.money_settings import (
    USUAL_CHANGE,
    FigureSettings,
    RangeSettings,
    RatesSettings,
    usual_ranges,
)
from synth.configuration.computer.settings import ComputerSettings
from synth.frame.input_error import InputError
from synth.yard.control_computer.computer_model import require_input
from synth.yard.control_computer.economics.economic_case import EconomicCase, Terms
from synth.yard.control_computer.economics.hump_day_change import (
    HumpDayChange,
    change_of_figures,
    change_of_trains,
    figures_of_trains,
    ranges_of_change,
)
from synth.yard.control_computer.economics.hump_rates import HumpChange, HumpRates
from synth.yard.control_computer.economics.prices import Prices
from synth.yard.control_computer.economics.traffic import Handling, Traffic
from synth.yard.control_computer.economics.uncertainty.ranges import (
    LogNormal,
    Measured,
    Range,
    Triangular,
    Uniform,
)
from synth.yard.humping.outcomes import TrainOutcomes
from synth.yard.humping.stored_trains import stored_trains


@dataclass(frozen=True)
class HumpFigures:
    """The figures of the hump today and their change; `found`: where that was simulated, with intervals.

    `sha256`: of the trains that it was told from, by their place in the configuration.
    """

    today: HumpRates
    change: HumpChange
    found: HumpDayChange | None
    sha256: Mapping[str, str]


def figure_sources(rates: RatesSettings, folder: Path, place: str) -> HumpFigures:
    """The figures as told, or from two directories of `hump simulate`; `InputError`."""
    if (rates.today_trial is None) != (rates.new_trial is None):
        raise InputError(f"{place}: rates: today_trial and new_trial go together; give both or none")
    if rates.today_trial is None or rates.new_trial is None:
        with_place = f"{place}: rates."
        return HumpFigures(told_rates(rates.today, with_place), HumpChange(**rates.change.model_dump()), None, {})
    read = {key: trains_in(folder / path, place, key) for key, path in (("today_trial", rates.today_trial),
                                                                       ("new_trial", rates.new_trial))}  # fmt: skip
    today, new = read["today_trial"][0], read["new_trial"][0]
    figures = figures_of_trains("today", today)
    same = len(today) == len(new) and bool((today.train == new.train).all() and (today.cuts == new.cuts).all())
    found = change_of_trains(today, new) if same else change_of_figures(figures, figures_of_trains("new", new))
    return HumpFigures(figures.rates, found.change, found, {key: digest for key, (_, digest) in read.items()})


def trains_in(directory: Path, place: str, key: str) -> tuple[TrainOutcomes, str]:
    """The trains that `hump simulate` left in `directory`, and the hash of their file."""
    stored = stored_trains(directory, f"{place}: rates.{key} is {str(directory)!r}")
    return stored.found, hashlib.sha256(stored.content).hexdigest()


def told_rates(told: FigureSettings, place: str) -> HumpRates:
    """The figures of today; `InputError` for one that no hump can have."""
    from synth.configuration.plant_fault import in_file

    with in_file(f"{place}today", lambda sentence: sentence):
        return HumpRates(**told.model_dump())


def asked_case(settings: ComputerSettings, figures: HumpFigures) -> EconomicCase:
    """All inputs of the economic calculation; `PlantError`."""
    return EconomicCase(
        prices=Prices(**settings.prices.model_dump()),
        traffic=Traffic(**settings.traffic.model_dump()),
        handling=Handling(**settings.handling.model_dump()),
        today=figures.today,
        change=figures.change,
        terms=Terms(**settings.terms.model_dump()),
    )


def asked_ranges(settings: ComputerSettings, figures: HumpFigures) -> dict[str, Range]:
    """Uncertain inputs by key; those of simulated differences are within their intervals. `PlantError`."""
    made = {} if figures.found is None else ranges_of_change(figures.found)
    told: set[str] = set()
    own_change = settings.rates.change != USUAL_CHANGE  # the intervals of the defaults are not those of other changes
    for each in settings.range:
        if own_change and each in usual_ranges() and each.law == "measured":
            continue
        require(each.input not in told, f"range: {each.input!r} is given twice")
        require_input(each.input)
        told.add(each.input)
        if not (figures.found is not None and each.input.startswith("change.")):
            made[each.input] = range_law(each, settings, figures)
    return made


def range_law(each: RangeSettings, settings: ComputerSettings, figures: HumpFigures) -> Range:
    """The distribution of one input; `PlantError` names it."""
    require(
        (each.mode is not None) == (each.law == "triangular"),
        f"range of {each.input}: mode is for law = 'triangular', which needs it; the law is {each.law!r}",
    )
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
