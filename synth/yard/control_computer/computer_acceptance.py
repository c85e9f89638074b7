"""Whether a control computer keeps its limits: waits, losses of a year, pay-back."""

from __future__ import annotations

import math
from dataclasses import dataclass

from synth.yard.control_computer.computer_results import ComputerResults


@dataclass(frozen=True)
class Limit:
    """One limit: a sentence that tells figure and limit; `kept` None where the draws do not decide it."""

    sentence: str
    kept: bool | None


@dataclass(frozen=True)
class ComputerVerdict:
    """All limits."""

    limits: tuple[Limit, ...]

    @property
    def accepted(self) -> bool:
        """Every limit is kept for sure."""
        return all(limit.kept for limit in self.limits)

    @property
    def sentence(self) -> str:
        """The limits that are not kept, or that all are."""
        missed = [limit.sentence for limit in self.limits if not limit.kept]
        return "; ".join(missed) if missed else "; ".join(limit.sentence for limit in self.limits)


def judge_computer(results: ComputerResults) -> ComputerVerdict:
    """The limits of the configuration."""
    return ComputerVerdict((wait_limit(results), *money_limits(results)))


def wait_limit(results: ComputerResults) -> Limit:
    """The processor is as fast as the allowed waits need."""
    service = results.config.service
    needed = results.sized.needed_op_s[service.discipline]
    return Limit(
        f"the allowed waits need {needed:,.0f} op/s, and the processor does {service.speed_op_s:,.0f}",
        results.sized.waits_allowed,
    )


def money_limits(results: ComputerResults) -> tuple[Limit, ...]:
    """Losses and pay-back, where the configuration limits them."""
    asked, found = results.config.settings.acceptance, []
    if asked.loss_per_year is not None:
        loss = results.config.upkeep.loss_per_year()
        found.append(
            Limit(
                f"failures lose {loss:.4g} a year, at most {asked.loss_per_year:g} asked", loss <= asked.loss_per_year
            )
        )
    if asked.pay_back_years is not None:
        found.append(pay_back_limit(results, asked.pay_back_years))
    return tuple(found)


def pay_back_limit(results: ComputerResults, most_years: float) -> Limit:
    """The pay-back, in 95 of 100 draws where inputs are uncertain."""
    if results.money is None:
        years = results.economics.pay_back.years
        told = "never" if years is None else f"in {years:.3g} years"
        return Limit(f"it pays back {told}, at most {most_years:g} asked", years is not None and years <= most_years)
    figures = next(each for each in results.money.figures if each.name == "pay_back_years")
    _, value, low, high = figures.quantiles[-1]
    told = "never" if math.isinf(value) else f"{value:.3g}"
    kept = True if high <= most_years else False if low > most_years else None
    return Limit(f"95 of 100 draws pay back in {told} years at most, {most_years:g} asked", kept)
