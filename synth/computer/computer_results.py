"""What is found of a control computer (how fast it must be, how reliable it is, what it pays), and whether it
keeps its limits.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from plant_models.errors import PlantError
from synth.computer.asked import ComputerModel
from synth.computer.economics.economic_case import EconomicResult
from synth.computer.economics.monte_carlo import Draws, OutputFigures, drawn, output_figures
from synth.computer.economics.ranges import Constant
from synth.computer.economics.sensitivity import SobolIndex, Tornado, sobol_of, tornado
from synth.computer.sized_computer import SizedComputer, sized
from synth.frame.command import Limit
from synth.frame.exhibits import shown_value
from synth.frame.interval import Interval
from synth.frame.printed_numbers import amount, as_known, per_cent, three_figures
from synth.frame.settings.settings_file import in_file

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


MOST_NEVER, HALF = 0.05, 0.5
"""Money is judged good where at most so large a share of the draws never pays back, bad where more than half never do;
between them the inputs are not known well enough."""


def computer_limits(results: ComputerResults) -> Iterator[Limit]:
    """Speed, reliability, money: one sentence each, with the limits of the configuration."""
    yield speed_limit(results)
    yield reliability_limit(results)
    yield money_limit(results)


def speed_limit(results: ComputerResults) -> Limit:
    """The processor is as fast as the allowed waits need."""
    service = results.config.settings.service
    needed = results.sized.needed_op_s[service.discipline]
    return Limit(
        f"speed: the allowed waits need {needed:,.0f} op/s, and the processor does {service.speed_op_s:,.0f}",
        results.sized.waits_allowed,
    )


def reliability_limit(results: ComputerResults) -> Limit:
    """A computer is ready as long as it must be, and failures cost no more than is allowed."""
    most, upkeep = results.config.settings.acceptance.loss_per_year, results.config.settings.reliability
    currency, loss, required = results.config.case.prices.currency, upkeep.loss_per_year(), upkeep.required_availability
    ready, computers = results.reliable.duplex_availability, "of two computers one is"
    if upkeep.structure == "single":
        ready, computers = results.reliable.single_availability, "the computer is"
    allowed = "" if most is None else f", at most {amount(most)} asked"
    return Limit(
        f"reliability: {computers} ready in {per_cent_of_time(ready)} of the time, {per_cent_of_time(required)} "
        f"required; failures lose {amount(loss)} {currency} a year{allowed}",
        ready >= required and (most is None or loss <= most),
    )


def per_cent_of_time(share: float) -> str:
    """A share near 1, to a thousandth of a per cent."""
    return f"{100.0 * share:.3f} %"


def money_limit(results: ComputerResults) -> Limit:
    """The investment pays back, in time where that is asked for, and in 95 of 100 draws where inputs are uncertain."""
    most, currency = results.config.settings.acceptance.pay_back_years, results.config.case.prices.currency
    if results.money is None:
        effect, years = results.economics.effect_per_year, results.economics.pay_back.years
        told = "never pays back" if years is None else f"pays back in {three_figures(years)} years"
        kept = years is not None and (most is None or years <= most)
        return Limit(f"money: it brings {amount(effect)} {currency} a year and {told}{asked_years(most)}", kept)
    low, middle, high = amounts_of(results.money, "effect_per_year")
    _, half, slow = quantiles_of(results.money, "pay_back_years")
    never = never_of(results.money)
    slowest = "" if math.isinf(slow.value) else f"; 95 of 100 pay back {when(slow)}"
    return Limit(
        f"money: it brings {middle} {currency} a year in the median, {low} to {high} in 90 of 100 draws; it pays back "
        f"{when(half)} in the median and never in {shown_value(never, per_cent)} of {never.n} draws{slowest}"
        f"{asked_years(most)}",
        pays_back(never) if most is None else in_time(slow, most),
    )


def quantiles_of(money: UncertainMoney, name: str) -> tuple[Interval, ...]:
    """5, 50 and 95 % of an output."""
    return next(each.quantiles for each in money.figures if each.name == name)


def amounts_of(money: UncertainMoney, name: str) -> tuple[str, ...]:
    """The same of an amount, with no more figures than their spread leaves."""
    low, middle, high = (each.value for each in quantiles_of(money, name))
    return tuple(amount(as_known(each, low, high)) for each in (low, middle, high))


def never_of(money: UncertainMoney) -> Interval:
    """The share of the draws that never pay back."""
    return next(each.never for each in money.figures if each.name == "pay_back_years")


def when(years: Interval) -> str:
    """A pay-back time in words; that of the slowest draws may never come."""
    return "never" if math.isinf(years.value) else f"within {three_figures(years.value)} years"


def asked_years(most: float | None) -> str:
    """The limit of the pay-back in words."""
    return "" if most is None else f", at most {most:g} years asked"


def pays_back(never: Interval) -> bool | None:
    """By the share of the draws that never pay back."""
    return True if never.high95 <= MOST_NEVER else False if never.low95 > HALF else None


def in_time(slow: Interval, most_years: float) -> bool | None:
    """By the time in which 95 of 100 draws pay back."""
    return True if slow.high95 <= most_years else False if slow.low95 > most_years else None
