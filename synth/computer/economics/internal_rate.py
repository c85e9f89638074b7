"""Internal rate of return of yearly flows of money."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from plant_models.errors import require

WIDEST = 700.0
"""ln(1 + r) is sought within ± this; beyond it 1 + r is no double."""


@dataclass(frozen=True)
class InternalRate:
    """`per_year`: the rate at which the flows are worth nothing, None where no single one is told; `statement`: why.

    `most`: how many rates are possible at most, by the rule of Descartes.
    """

    per_year: float | None
    most: int
    statement: str


def internal_rate(flows: Sequence[float]) -> InternalRate:
    """IRR of `flows` at the start and at the end of each year, any rate above −1; `PlantError` for no number.

    Flows are a polynomial in 1/(1 + r). Where they change their sign once, it has one positive root. Where they change
    it more often, it may have several and none of them is told, but for one case: sums of the flows up to each year
    that change sign once, and end positive, leave one rate above 0 (Norstrøm 1972).
    """
    require(all(math.isfinite(flow) for flow in flows), "the flows of money must be finite numbers")
    changes = sign_changes(flows)
    if changes == 0:
        return InternalRate(None, 0, "There is no internal rate: money goes one way only.")
    if changes == 1:
        rate = root(flows, -WIDEST)
        return InternalRate(rate, 1, f"The internal rate is {rate:.4g} a year.")
    sums = np.cumsum(flows)
    if flows[0] < 0.0 and sign_changes(sums.tolist()) == 1 and sums[-1] > 0.0:
        rate = root(flows, 0.0)
        return InternalRate(rate, changes, f"The internal rate is {rate:.4g} a year, the only one above 0.")
    return InternalRate(None, changes, f"There may be up to {changes} internal rates; none of them is told.")


def sign_changes(flows: Sequence[float]) -> int:
    """How often the sign changes from one flow to the next; zeros are left out."""
    signs = [flow > 0.0 for flow in flows if flow != 0.0]
    return sum(one != other for one, other in pairwise(signs))


def root(flows: Sequence[float], lowest: float) -> float:
    """The one rate whose ln(1 + r) is above `lowest`.

    Sought in x = ln(1 + r), from where the last flow decides to where the first one does. A worth is scaled by its
    largest discount, so nothing overflows.
    """
    from scipy.optimize import brentq  # start-up: scipy only where it is needed

    years = np.flatnonzero(flows)
    held = np.asarray(flows, dtype=float)[years]

    def worth(x: float) -> float:
        exponent = -years * x
        return float((held * np.exp(exponent - exponent.max())).sum())

    found = brentq(worth, lowest, WIDEST, xtol=1e-14, rtol=8.9e-16)
    return math.expm1(float(found))
