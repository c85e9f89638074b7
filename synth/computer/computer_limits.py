"""Whether a control computer keeps its limits: waits, losses of a year, pay-back."""

from __future__ import annotations

import math
from collections.abc import Iterator

from synth.computer.computer_results import ComputerResults
from synth.frame.command import Limit


def computer_limits(results: ComputerResults) -> Iterator[Limit]:
    """The limits of the configuration."""
    yield wait_limit(results)
    yield from money_limits(results)


def wait_limit(results: ComputerResults) -> Limit:
    """The processor is as fast as the allowed waits need."""
    service = results.config.settings.service
    needed = results.sized.needed_op_s[service.discipline]
    return Limit(
        f"the allowed waits need {needed:,.0f} op/s, and the processor does {service.speed_op_s:,.0f}",
        results.sized.waits_allowed,
    )


def money_limits(results: ComputerResults) -> Iterator[Limit]:
    """Losses and pay-back, where the configuration limits them."""
    asked, upkeep = results.config.settings.acceptance, results.config.settings.reliability
    if asked.loss_per_year is not None:
        loss = upkeep.loss_per_year()
        yield Limit(
            f"failures lose {loss:.4g} a year, at most {asked.loss_per_year:g} asked", loss <= asked.loss_per_year
        )
    if asked.pay_back_years is not None:
        yield pay_back_limit(results, asked.pay_back_years)


def pay_back_limit(results: ComputerResults, most_years: float) -> Limit:
    """The pay-back, in 95 of 100 draws where inputs are uncertain."""
    if results.money is None:
        years = results.economics.pay_back.years
        told = "never" if years is None else f"in {years:.3g} years"
        return Limit(f"it pays back {told}, at most {most_years:g} asked", years is not None and years <= most_years)
    figures = next(each for each in results.money.figures if each.name == "pay_back_years")
    slow = figures.quantiles[-1]
    told = "never" if math.isinf(slow.value) else f"{slow.value:.3g}"
    kept = True if slow.high95 <= most_years else False if slow.low95 > most_years else None
    return Limit(f"95 of 100 draws pay back in {told} years at most, {most_years:g} asked", kept)
