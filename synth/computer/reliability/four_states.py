"""The control computer as a Markov chain of four states (ready, failed unnoticed, in maintenance, in repair), and
what failures cost in a year.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from plant_models.frozen_arrays import Floats


class State(IntEnum):
    """A state of the computer; its value is its place in vectors and matrices."""

    READY = 0
    FAILED_UNNOTICED = 1
    MAINTENANCE = 2
    REPAIR = 3


@dataclass(frozen=True)
class FourStates:
    """The chain of [hump-computer-1970s], chapter 4; every rate per hour, every stay exponential.

    `failure_per_h` λ: ready → failed unnoticed. `detection_per_h` μ: the computer notices its failure → repair.
    `check_per_h` ν: a check, of a ready or a failed computer → maintenance. `maintenance_per_h` ε and `repair_per_h` γ:
    back to ready. The print lets the check of a failed computer lead to maintenance, which thus repairs it;
    `failed_check_to` = `State.REPAIR` sends it to repair instead.

    λ, ε, γ must be positive; of μ and ν one may be 0, but not both: nobody would ever notice a failure.
    """

    failure_per_h: float
    detection_per_h: float
    check_per_h: float
    maintenance_per_h: float
    repair_per_h: float
    failed_check_to: State = State.MAINTENANCE

    def generator_per_h(self) -> Floats:
        """The generator Q (4, 4): Q[i, j] is the rate from state i to state j, and every row sums to 0."""
        q = np.zeros((4, 4))
        q[State.READY, State.FAILED_UNNOTICED] = self.failure_per_h
        q[State.READY, State.MAINTENANCE] = self.check_per_h
        q[State.FAILED_UNNOTICED, State.REPAIR] = self.detection_per_h
        q[State.FAILED_UNNOTICED, self.failed_check_to] += self.check_per_h
        q[State.MAINTENANCE, State.READY] = self.maintenance_per_h
        q[State.REPAIR, State.READY] = self.repair_per_h
        np.fill_diagonal(q, -q.sum(axis=1))
        return q

    def stationary(self) -> StateShares:
        """The stationary probabilities in closed form: the balance of each state.

        λp1 = (ν + μ)p2. As printed: ν(p1 + p2) = εp3 and μp2 = γp4; with a check that leads to repair: νp1 = εp3 and
        (ν + μ)p2 = γp4.
        """
        failed = self.failure_per_h / (self.check_per_h + self.detection_per_h)
        to_repair = self.failed_check_to is State.REPAIR
        checked = 1.0 if to_repair else 1.0 + failed
        repaired = self.failure_per_h if to_repair else self.detection_per_h * failed
        weights = (1.0, failed, self.check_per_h * checked / self.maintenance_per_h, repaired / self.repair_per_h)
        total = sum(weights)
        return StateShares(*(weight / total for weight in weights))

    def transient(self, hours: Floats, start: State = State.READY) -> Floats:
        """Probabilities (n, 4) of the states `hours` (n,) after the computer was in `start`: the row of e^{Qt}."""
        from scipy.linalg import expm

        return np.asarray(expm(self.generator_per_h() * np.asarray(hours)[:, None, None])[:, start, :])


@dataclass(frozen=True)
class StateShares:
    """Share of time that the computer is in each state; the four sum to 1."""

    ready: float
    failed_unnoticed: float
    maintenance: float
    repair: float

    @property
    def availability(self) -> float:
        """Share of time in which the computer controls, and does so rightly."""
        return self.ready


HOURS_PER_YEAR = 8760.0
"""24 · 365, as [hump-computer-1970s] counts them."""


@dataclass(frozen=True)
class HourPrices:
    """Loss an hour: `unnoticed` Su while the computer has failed and nobody knows, `by_hand` Sc while it is maintained
    or repaired and the train is humped slower by hand. Any currency."""

    unnoticed: float
    by_hand: float


@dataclass(frozen=True)
class YearlyLoss:
    """Losses of a year, in the currency of the prices."""

    unnoticed: float
    maintenance: float
    repair: float

    @property
    def total(self) -> float:
        """All of them."""
        return self.unnoticed + self.maintenance + self.repair


def yearly_loss(shares: StateShares, prices: HourPrices) -> YearlyLoss:
    """S = (p2·Su + (p3 + p4)·Sc)·8760, [hump-computer-1970s], chapter 4."""
    return YearlyLoss(
        HOURS_PER_YEAR * shares.failed_unnoticed * prices.unnoticed,
        HOURS_PER_YEAR * shares.maintenance * prices.by_hand,
        HOURS_PER_YEAR * shares.repair * prices.by_hand,
    )
