"""Two computers that run side by side, and are checked one after the other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models.errors import require
from plant_models.frozen_arrays import Floats

LONGEST_CHECK = 3.0
"""Up to so many mean times between failures of a check, availability falls for all longer periods. With 3.6 and more it
rises again over some of them, where it is about a quarter."""


@dataclass(frozen=True)
class Duplex:
    """Two equal computers, of which one ready is enough; both are as new at the start of each period.

    `failure_per_h` λ of each. In the last `check_h` τк of the period one of them works alone while the other is
    checked. Nothing is repaired within a period.
    """

    failure_per_h: float
    check_h: float

    def availability(self, period_h: Floats | float) -> Floats:
        """Kг(x): the mean share of a period x in which the hump has a ready computer; x ≥ τк.

        Kг(x) = 3/(2λx) + e^{−2λ(x−τк)}/(2λx) − (1 + e^{λτк})·e^{−λx}/(λx), [hump-computer-1970s], is the integral
        1/x·[∫₀^{x−τк}(2e^{−λt} − e^{−2λt})dt + ∫_{x−τк}^{x}e^{−λt}dt]. The print has "1 − e^{−λτк}" in the place of
        1 + e^{λτк}; with it Kг exceeds 1, and does not go to 1 as λ goes to 0. The mean is over a period, no steady
        state.
        """
        from scipy.special import exprel

        period = np.asarray(period_h, dtype=np.float64)
        rate, together = self.failure_per_h, period - self.check_h
        # exprel(−y) = (1 − e^{−y})/y
        both = together * (2.0 * exprel(-rate * together) - exprel(-2.0 * rate * together))
        alone = self.check_h * np.exp(-rate * together) * exprel(-rate * self.check_h)
        return np.asarray(np.minimum((both + alone) / period, 1.0))  # rounding alone can exceed 1

    def longest_period_h(self, required: float) -> float:
        """The longest period whose availability is at least `required`; availability falls with the period.

        `PlantError` where no period keeps it: a period is at least the check, in which one computer works alone; and
        for checks longer than `LONGEST_CHECK`.
        """
        from scipy.optimize import brentq

        require(
            self.failure_per_h * self.check_h <= LONGEST_CHECK,
            f"duplex: check_h is {self.check_h:g} h; no longest period is looked for with checks of more than "
            f"{LONGEST_CHECK:g} mean times between failures, {LONGEST_CHECK / self.failure_per_h:g} h",
        )
        low = max(self.check_h, 1e-12 / self.failure_per_h)
        best = float(self.availability(low))
        require(
            required <= best,
            f"duplex: a required availability of {required:.9g}; checks of {self.check_h:g} h, in which one computer "
            f"works alone, allow {best:.9g} at most: shorten the checks or lower the requirement",
        )
        high = 2.0 * low
        while float(self.availability(high)) >= required:
            high *= 2.0
        return float(brentq(lambda x: float(self.availability(x)) - required, low, high, xtol=1e-12 * high))


def single_availability(failure_per_h: float, check_h: float, period_h: Floats | float) -> Floats:
    """(1 − e^{−λ(x−τк)})/(λx): the same of one computer alone, which is not there while it is checked."""
    period = np.asarray(period_h, dtype=np.float64)
    return np.asarray(-np.expm1(-failure_per_h * (period - check_h)) / (failure_per_h * period))
