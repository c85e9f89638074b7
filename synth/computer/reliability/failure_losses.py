"""What failures of the control computer cost in a year."""

from __future__ import annotations

from dataclasses import dataclass

from synth.computer.reliability.four_states import StateShares

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
