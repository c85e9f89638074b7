"""Internal rate of return of yearly flows of money."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from synth.computer.economics.present_value import Investment

WIDEST = 700.0
"""ln(1 + r) is sought within ± this; beyond it 1 + r is no double."""


@dataclass(frozen=True)
class InternalRate:
    """`per_year`: the rate at which the flows are worth nothing, None where there is none; `statement`: in words."""

    per_year: float | None
    statement: str


def internal_rate(investment: Investment) -> InternalRate:
    """IRR of what is spent and of the income of each year, any rate above −1.

    Where money goes both ways its worth has one root, by the rule of Descartes: the flows change their sign once.
    """
    if investment.spent * investment.income_per_year <= 0.0:
        return InternalRate(None, "There is no internal rate: money goes one way only.")
    rate = root(investment.flows)
    return InternalRate(rate, f"The internal rate is {100.0 * rate:.3g} % a year.")


def root(flows: Sequence[float]) -> float:
    """The rate at which `flows` at the start and at the end of each year are worth nothing.

    Sought in x = ln(1 + r), from where the last flow decides to where the first one does. A worth is scaled by its
    largest discount, so nothing overflows.
    """
    from scipy.optimize import brentq  # start-up: scipy only where it is needed

    years = np.flatnonzero(flows)
    held = np.asarray(flows, dtype=float)[years]

    def worth(x: float) -> float:
        exponent = -years * x
        return float((held * np.exp(exponent - exponent.max())).sum())

    found = brentq(worth, -WIDEST, WIDEST, xtol=1e-14, rtol=8.9e-16)
    return math.expm1(float(found))
