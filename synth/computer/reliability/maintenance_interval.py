"""The best interval between checks of one computer that does not notice its own failures."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from synth.computer.reliability.rates import HOURS_PER_YEAR, require_positive

Floats = NDArray[np.float64]


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

    def __post_init__(self) -> None:
        for key, value in vars(self).items():
            require_positive(f"maintenance interval: {key}", value)

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

    def loss_per_h(self, interval_h: Floats | float, counted: Counted) -> Floats:
        """Loss an hour of what is `counted`, at intervals of `interval_h`."""
        return np.asarray(self.cycle_loss(interval_h) / counted.hours(self, interval_h))

    def loss_per_year(self, interval_h: Floats | float) -> Floats:
        """Mean loss of a year of 8760 h, checks included."""
        return HOURS_PER_YEAR * self.loss_per_h(interval_h, CalendarHours())


class Counted(Protocol):
    """Which hours of a cycle a loss is counted by; the best interval depends on it a little."""

    def hours(self, computer: CheckedComputer, interval_h: Floats | float) -> Floats:
        """Mean hours of a cycle that count."""

    def best_interval_h(self, computer: CheckedComputer) -> float:
        """The interval of the least loss; infinite where no check pays."""


@dataclass(frozen=True)
class UsefulHours:
    """Hours in which the computer is ready, G(x): what [hump-computer-1970s] minimises."""

    def hours(self, computer: CheckedComputer, interval_h: Floats | float) -> Floats:
        """See `Counted`."""
        return computer.ready_h(interval_h)

    def best_interval_h(self, computer: CheckedComputer) -> float:
        """The root of e^{λx} − λx = 1 + λτ·Sc/Su.

        The source prints "e^{−λx} − λx = 1 + λ·Sc/Su". With the negative exponent the left side is below 1 for every
        x > 0, so there is no root; without τ the right side adds a rate to a number. N'G = NG' gives both.
        """
        y = root(lambda y: math.expm1(y) - y - computer.check_worth, math.sqrt(2.0 * computer.check_worth))
        return y / computer.failure_per_h


@dataclass(frozen=True)
class WorkingHours:
    """Hours between checks, x, whether the computer has failed in them or not."""

    def hours(self, computer: CheckedComputer, interval_h: Floats | float) -> Floats:
        """See `Counted`."""
        return np.asarray(interval_h, dtype=np.float64)

    def best_interval_h(self, computer: CheckedComputer) -> float:
        """The root of 1 − e^{−λx}(1 + λx) = λτ·Sc/Su; none where the right side is 1 or more."""
        return interval_of_cycle_h(computer, 0.0)


@dataclass(frozen=True)
class CalendarHours:
    """All hours of the cycle, x + τ."""

    def hours(self, computer: CheckedComputer, interval_h: Floats | float) -> Floats:
        """See `Counted`."""
        return np.asarray(interval_h) + computer.check_h

    def best_interval_h(self, computer: CheckedComputer) -> float:
        """The root of 1 + λτ − e^{−λx}(1 + λx + λτ) = λτ·Sc/Su; none where an hour by hand costs too much."""
        return interval_of_cycle_h(computer, computer.check_h)


def interval_of_cycle_h(computer: CheckedComputer, more_h: float) -> float:
    """The x that minimises N(x)/(x + `more_h`), infinite where N/(x + …) falls for ever."""
    more, worth = computer.failure_per_h * more_h, computer.check_worth
    if worth >= 1.0 + more:
        return math.inf

    def short_of(y: float) -> float:
        return -math.expm1(-y) * (1.0 + more) - y * math.exp(-y) - worth

    return root(short_of, math.sqrt(2.0 * worth)) / computer.failure_per_h


def small_rate_interval_h(computer: CheckedComputer) -> float:
    """√(2τSc/(λS1)): all three intervals where λx and λτ are small."""
    return math.sqrt(2.0 * computer.check_worth) / computer.failure_per_h


def root(rising: Callable[[float], float], guess: float) -> float:
    """The positive root of a function that rises from below 0; `guess` is its order of magnitude."""
    from scipy.optimize import brentq

    high = guess
    while rising(high) <= 0.0:
        high *= 2.0
    return float(brentq(rising, 0.0, high, xtol=1e-15 * high, rtol=1e-14))
