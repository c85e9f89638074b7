"""k of n equal computers, some of whose failures have a common cause: with repair, and without it between checks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.errors import require, require_between
from synth.yard.control_computer.reliability.rates import require_positive
from synth.yard.control_computer.reliability.stationary import stationary_shares

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Redundant:
    """`computers` n run side by side; the hump is controlled as long as `needed` k of them are ready.

    `failure_per_h` λ of each. The share `common_share` β of it has a common cause that fails all at once (beta-factor
    model): each fails for itself with (1 − β)λ, and all of them together with βλ.
    """

    needed: int
    computers: int
    failure_per_h: float
    common_share: float = 0.0

    def __post_init__(self) -> None:
        require(self.computers >= 1, f"redundancy: computers is {self.computers}; there must be 1 or more")
        require(
            1 <= self.needed <= self.computers,
            f"redundancy: needed is {self.needed}; it must be from 1 to computers, {self.computers}",
        )
        require_positive("redundancy: failure_per_h", self.failure_per_h)
        require_between("redundancy: common_share", self.common_share, 0.0, 1.0)

    @property
    def own_per_h(self) -> float:
        """(1 − β)λ: failures of one computer alone."""
        return (1.0 - self.common_share) * self.failure_per_h

    @property
    def common_per_h(self) -> float:
        """βλ: failures of all at once."""
        return self.common_share * self.failure_per_h

    def failed_after(self, hours: Floats | float) -> Floats:
        """Probability that fewer than k are ready `hours` after all were, without repair.

        1 − e^{−βλt}·P(n − k failed for themselves or fewer), each with the probability 1 − e^{−(1−β)λt}.
        """
        from scipy.special import bdtrc

        t = np.asarray(hours, dtype=np.float64)
        by_own = bdtrc(self.computers - self.needed, self.computers, -np.expm1(-self.own_per_h * t))
        return np.asarray(-np.expm1(-self.common_per_h * t) + np.exp(-self.common_per_h * t) * by_own)

    def checked_unavailability(self, period_h: float) -> float:
        """Mean share of a period in which fewer than k are ready, where all are as new after each check."""
        from scipy.integrate import quad

        require_positive("redundancy: period_h", period_h)
        failed, _ = quad(lambda t: float(self.failed_after(t)), 0.0, period_h, epsabs=0.0, epsrel=1e-10, limit=200)
        return float(failed) / period_h

    def checked_availability(self, period_h: float) -> float:
        """1 − `checked_unavailability`."""
        return 1.0 - self.checked_unavailability(period_h)


@dataclass(frozen=True)
class Repaired:
    """The computers of `redundant` with repair as soon as they fail: by `crews`, each one computer at a time.

    `repair_per_h` γ: of one crew. Repaired computers work at once, also where fewer than k are ready; a common cause
    fails those that are ready.
    """

    redundant: Redundant
    repair_per_h: float
    crews: int = 1

    def __post_init__(self) -> None:
        require_positive("redundancy: repair_per_h", self.repair_per_h)
        require(self.crews >= 1, f"redundancy: crews is {self.crews}; there must be 1 or more")

    def generator_per_h(self) -> Floats:
        """Generator (n + 1, n + 1) of the number that have failed: one more, one less, or all at once."""
        n, of = self.redundant.computers, self.redundant
        q = np.zeros((n + 1, n + 1))
        for failed in range(n):
            q[failed, failed + 1] += (n - failed) * of.own_per_h
            q[failed, n] += of.common_per_h
            q[failed + 1, failed] = min(failed + 1, self.crews) * self.repair_per_h
        np.fill_diagonal(q, -q.sum(axis=1))
        return q

    def shares(self) -> Floats:
        """Stationary share of time (n + 1,) with 0, 1, … n failed."""
        return stationary_shares(self.generator_per_h())

    @property
    def unavailability(self) -> float:
        """Share of time with fewer than k ready."""
        return float(self.shares()[self.redundant.computers - self.redundant.needed + 1 :].sum())

    @property
    def availability(self) -> float:
        """Share of time with k or more ready."""
        return float(self.shares()[: self.redundant.computers - self.redundant.needed + 1].sum())
