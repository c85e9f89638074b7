"""The best interval between checks of one computer that does not notice its own failures, and of two that run side
by side and are checked one after the other.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from plant_models.errors import require
from plant_models.frozen_arrays import Floats
from synth.computer.reliability.four_states import HOURS_PER_YEAR

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


@dataclass(frozen=True)
class CheckedComputer:
    """One computer that is as new after each check; a failure is found by the next check only.

    `failure_per_h` λ; `check_h` τ: how long the hump is controlled by hand for a check, the repair of what it finds
    included; `manual_price_per_h` Sc: what an hour by hand costs; `unnoticed_price_per_h` Su: what an hour costs in
    which the computer has failed and nobody knows. Prices in any one currency; what counts is Sc/Su.
    """

    failure_per_h: float
    check_h: float
    manual_price_per_h: float
    unnoticed_price_per_h: float

    @property
    def check_worth(self) -> float:
        """λτ·Sc/Su: the price of a check against that of an hour unnoticed, in mean times between failures."""
        price = self.check_h * self.manual_price_per_h / self.unnoticed_price_per_h
        return self.failure_per_h * price

    def ready_h(self, interval_h: Floats | float) -> Floats:
        """G(x) = (1 − e^{−λx})/λ: mean hours of an interval in which the computer has not failed."""
        return np.asarray(-np.expm1(-self.failure_per_h * np.asarray(interval_h)) / self.failure_per_h)

    def cycle_loss(self, interval_h: Floats | float) -> Floats:
        """N(x) = Su·(x − G) + Sc·τ: mean loss of an interval and the check that ends it."""
        unnoticed_h = np.asarray(interval_h) - self.ready_h(interval_h)
        return np.asarray(self.unnoticed_price_per_h * unnoticed_h + self.manual_price_per_h * self.check_h)

    def loss_per_year(self, interval_h: Floats | float) -> Floats:
        """Mean loss of a year of 8760 h, checks included."""
        return HOURS_PER_YEAR * np.asarray(self.cycle_loss(interval_h) / (np.asarray(interval_h) + self.check_h))

    @property
    def best_useful_h(self) -> float:
        """The interval of the least loss an hour of use, N/G, which [hump-computer-1970s] minimises: the root of
        e^{λx} − λx = 1 + λτ·Sc/Su.

        The source prints "e^{−λx} − λx = 1 + λ·Sc/Su". With the negative exponent the left side is below 1 for every
        x > 0, so there is no root; without τ the right side adds a rate to a number. N'G = NG' gives both.
        """
        y = root(lambda y: math.expm1(y) - y - self.check_worth, math.sqrt(2.0 * self.check_worth))
        return y / self.failure_per_h

    @property
    def best_calendar_h(self) -> float:
        """The interval of the least loss of a year: the root of 1 + λτ − e^{−λx}(1 + λx + λτ) = λτ·Sc/Su.

        Infinite where no check pays, because an hour by hand costs too much.
        """
        more, worth = self.failure_per_h * self.check_h, self.check_worth
        if worth >= 1.0 + more:
            return math.inf

        def short_of(y: float) -> float:
            return -math.expm1(-y) * (1.0 + more) - y * math.exp(-y) - worth

        return root(short_of, math.sqrt(2.0 * worth)) / self.failure_per_h


def root(rising: Callable[[float], float], guess: float) -> float:
    """The positive root of a function that rises from below 0; `guess` is its order of magnitude."""
    from scipy.optimize import brentq

    high = guess
    while rising(high) <= 0.0:
        high *= 2.0
    return float(brentq(rising, 0.0, high, xtol=1e-15 * high, rtol=1e-14))
