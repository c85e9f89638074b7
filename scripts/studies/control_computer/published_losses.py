"""Losses by failures, maintenance interval and pay-back of the published control computer, worked through again.

The source tells neither failure rate nor prices but Su, 1.3 to 5 thousand roubles an hour. Su = 5, λ = 0.0024/h and
checks every 2.5 h are one set that gives its loss of a single computer; nothing else is fitted.
"""

from __future__ import annotations

from dataclasses import dataclass

from synth.computer.economics.pay_back import pay_back, yearly_effect
from synth.computer.reliability.duplex import Duplex, single_availability
from synth.computer.reliability.failure_losses import HOURS_PER_YEAR, HourPrices, yearly_loss
from synth.computer.reliability.four_states import FourStates, StateShares
from synth.computer.reliability.maintenance_interval import CheckedComputer

UNNOTICED_K_RUB_PER_H = 5.0
FAILURE_PER_H, INTERVAL_H = 0.0024, 2.5
"""λ is assumed; x is the middle of the published 2 to 3 h."""

CHECK_H = 0.25
"""Of a duplex, assumed."""

DUPLEX_K_RUB, DUPLEX_PERIOD_H = 1.5, 4.2
PUBLISHED_INTERVALS_H = (2.0, 3.0)
SAVINGS_K_RUB, CAPITAL_K_RUB, NORMATIVE = (40.0, 85.0), (240.0, 1000.0), (0.12, 0.15)
INVESTMENTS_K_RUB, EFFECTS_K_RUB = (800.0 / 3.0, 160.0), (200.0, 80.0)
"""Investments are not told: these give the published 2 and 4 years for the published effects."""


@dataclass(frozen=True)
class PublishedLosses:
    """Thousand roubles a year unless the name tells another unit.

    `single`: one computer with checks at fixed times; `chain_ratio`: how much more the chain with random checks of the
    same rate tells. `duplex`: a pair with checks of no length at the same period; `duplex_period_h`: the period at
    which it loses the published 1.5; `longest_check_min`: with longer checks no period does; `duplex_with_checks`: with
    checks of 0.25 h every 4.2 h. `worth_h`: τSc/Su that make 2, 2.5 and 3 h the best interval. `effects`: yearly
    effects of the published savings at both normative efficiencies; `pay_back_years` with the assumed investments.
    """

    single: float
    chain_ratio: float
    duplex: float
    duplex_period_h: float
    longest_check_min: float
    duplex_with_checks: float
    worth_h: tuple[float, float, float]
    effects: tuple[float, float, float, float]
    pay_back_years: tuple[float, float]


def published_losses() -> PublishedLosses:
    """All of them."""
    pair = Duplex(FAILURE_PER_H, 0.0)
    needed = DUPLEX_K_RUB / (HOURS_PER_YEAR * UNNOTICED_K_RUB_PER_H)
    alone = 1.0 - float(single_availability(FAILURE_PER_H, 0.0, INTERVAL_H))
    chain = FourStates(FAILURE_PER_H, 0.0, 1.0 / INTERVAL_H, 4.0, 0.5).stationary()
    low, middle, high = (check_worth_h(x) for x in (PUBLISHED_INTERVALS_H[0], INTERVAL_H, PUBLISHED_INTERVALS_H[1]))
    effects = [
        yearly_effect(e, k, n, 0.0) for n in NORMATIVE for e, k in zip(SAVINGS_K_RUB, CAPITAL_K_RUB, strict=True)
    ]
    first, second = (pay_back(a, b).years for a, b in zip(INVESTMENTS_K_RUB, EFFECTS_K_RUB, strict=True))
    assert first is not None
    assert second is not None
    return PublishedLosses(
        single=loss_k_rub(alone),
        chain_ratio=chain.failed_unnoticed / (chain.ready + chain.failed_unnoticed) / alone,
        duplex=loss_k_rub(1.0 - float(pair.availability(INTERVAL_H))),
        duplex_period_h=pair.longest_period_h(1.0 - needed),
        longest_check_min=60.0 * 2.0 * needed / FAILURE_PER_H,
        duplex_with_checks=loss_k_rub(1.0 - float(Duplex(FAILURE_PER_H, CHECK_H).availability(DUPLEX_PERIOD_H))),
        worth_h=(low, middle, high),
        effects=(effects[0], effects[1], effects[2], effects[3]),
        pay_back_years=(first, second),
    )


def loss_k_rub(unnoticed: float) -> float:
    """A year of failures that are unnoticed for this share of the time."""
    shares = StateShares(1.0 - unnoticed, unnoticed, 0.0, 0.0)
    return yearly_loss(shares, HourPrices(UNNOTICED_K_RUB_PER_H, 0.0)).total


def check_worth_h(interval_h: float) -> float:
    """The price of a check, in hours of an unnoticed failure, that makes `interval_h` the best interval."""
    from scipy.optimize import brentq

    def too_long(worth_h: float) -> float:
        computer = CheckedComputer(FAILURE_PER_H, worth_h, UNNOTICED_K_RUB_PER_H, UNNOTICED_K_RUB_PER_H)
        return computer.best_useful_h - interval_h

    return float(brentq(too_long, 1e-6, 1.0, xtol=1e-12))
