"""What is found of a control computer: how fast it must be, how reliable it is, and what it pays."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from plant_models.errors import PlantError
from synth.computer.computer_model import ComputerModel
from synth.computer.economics.economic_case import EconomicResult
from synth.computer.economics.uncertainty.monte_carlo import (
    Draws,
    OutputFigures,
    drawn,
    output_figures,
)
from synth.computer.economics.uncertainty.ranges import Constant
from synth.computer.economics.uncertainty.sobol import SobolIndex, sobol_of
from synth.computer.economics.uncertainty.tornado import Tornado, tornado
from synth.computer.sized_computer import SizedComputer, sized
from synth.frame.settings.file_fault import in_file

if TYPE_CHECKING:
    from synth.computer.resolved_computer import ResolvedComputer

OUTPUTS = (
    "failure_loss_per_year", "savings_per_year", "released_capital", "effect_per_year", "pay_back_years",
    "net_present_value", "discounted_pay_back_years",
)  # fmt: skip
SHARED = ("pay_back_rate_per_year", "net_present_value")
"""Outputs whose variance is shared out: they are finite where a pay-back never comes."""


@dataclass(frozen=True)
class ReliableComputer:
    """Best intervals between checks, h (None where none is), and losses of a year with one computer and with two.

    `longest_period_h`: of two that keep the required availability; None where no period does, `why_none` says why.
    """

    best_useful_h: float | None
    best_calendar_h: float | None
    single_availability: float
    single_loss: tuple[float, float, float]
    duplex_availability: float
    duplex_loss: float
    longest_period_h: float | None
    why_none: str


@dataclass(frozen=True)
class UncertainMoney:
    """Results over all draws; `no_sobol` says why there are no indices."""

    draws: Draws
    figures: tuple[OutputFigures, ...]
    tornado: Tornado
    sobol: tuple[SobolIndex, ...]
    no_sobol: str


@dataclass(frozen=True)
class ComputerResults:
    """All of it; `money` None where no input is uncertain."""

    config: ResolvedComputer
    sized: SizedComputer
    reliable: ReliableComputer
    economics: EconomicResult
    money: UncertainMoney | None


def computer_results(config: ResolvedComputer, done: Callable[[str], None] = lambda part: None) -> ComputerResults:
    """Everything; `InputError` where the hump or the computer is overloaded. `done` hears of each part."""
    with in_file(config.place):
        return found_results(config, done)


def found_results(config: ResolvedComputer, done: Callable[[str], None]) -> ComputerResults:
    """The same; `PlantError`."""
    model = ComputerModel(config.case, config.settings.reliability)
    economics = model.result()
    done("what it pays")
    size = sized(config)
    done("how fast")
    results = ComputerResults(config, size, reliable(config), economics, uncertain_money(config, model))
    done("uncertain inputs")
    return results


def reliable(config: ResolvedComputer) -> ReliableComputer:
    """Reliability and what failures cost."""
    upkeep = config.settings.reliability
    checked, loss, longest, why = upkeep.checked, upkeep.single_loss(), None, ""
    try:
        longest = upkeep.duplex.longest_period_h(upkeep.required_availability)
    except PlantError as fault:
        why = str(fault)
    return ReliableComputer(
        best_useful_h=None if checked is None else checked.best_useful_h,
        best_calendar_h=None if checked is None else checked.best_calendar_h,
        single_availability=upkeep.chain.stationary().availability,
        single_loss=(loss.unnoticed, loss.maintenance, loss.repair),
        duplex_availability=1.0 - upkeep.duplex_unavailability,
        duplex_loss=upkeep.duplex_loss_per_year(),
        longest_period_h=longest,
        why_none=why,
    )


def uncertain_money(config: ResolvedComputer, model: ComputerModel) -> UncertainMoney | None:
    """The ranges carried through; None where every input is known."""
    if all(isinstance(each, Constant) for each in config.ranges.values()):
        return None
    asked = config.settings.uncertainty
    draws = drawn(model.figures, config.ranges, asked.draws, asked.seed)
    figures = tuple(output_figures(draws, name) for name in OUTPUTS)
    sobol: tuple[SobolIndex, ...] = ()
    why = ""
    try:
        sobol = sobol_of(model.figures, config.ranges, SHARED, asked.sobol_points, seed=asked.seed)
    except PlantError as fault:
        why = str(fault)
    return UncertainMoney(draws, figures, tornado(model.figures, config.ranges, "net_present_value"), sobol, why)
