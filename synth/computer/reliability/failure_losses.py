"""What failures of the control computer cost: in a year, and for each cut that an unnoticed failure befalls."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models.errors import require_between
from synth.computer.reliability.four_states import StateShares
from synth.computer.reliability.rates import HOURS_PER_YEAR, require_not_negative


@dataclass(frozen=True)
class HourPrices:
    """Loss an hour: `unnoticed` Su while the computer has failed and nobody knows, `by_hand` Sc while it is maintained
    or repaired and the train is humped slower by hand. Any currency."""

    unnoticed: float
    by_hand: float

    def __post_init__(self) -> None:
        for key, value in vars(self).items():
            require_not_negative(f"hour prices: {key}", value)


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


@dataclass(frozen=True)
class CutPrices:
    """What happens to a cut costs: `damage` Sd of cars that couple so fast that they are damaged, which is the share
    `damaged_share` β of couplings with over-speed; `re_sorting` Sr of a cut that went to another track."""

    damage: float
    re_sorting: float
    damaged_share: float

    def __post_init__(self) -> None:
        require_not_negative("cut prices: damage", self.damage)
        require_not_negative("cut prices: re_sorting", self.re_sorting)
        require_between("cut prices: damaged_share", self.damaged_share, 0.0, 1.0)


@dataclass(frozen=True)
class CutRisks:
    """While a failure is unnoticed: share of cuts that couple with over-speed, P1, and that go to another track, P2."""

    overspeed: float
    other_track: float

    def __post_init__(self) -> None:
        for key, value in vars(self).items():
            require_between(f"cut risks: {key}", value, 0.0, 1.0)

    def loss_per_cut(self, prices: CutPrices) -> float:
        """S = P1·Sd·β + P2·Sr, [hump-computer-1970s], chapter 4: the mean loss of a cut.

        Gaps are left out there, because P2 is so large; the study `control-computer` counts them too.
        """
        return self.overspeed * prices.damage * prices.damaged_share + self.other_track * prices.re_sorting

    def loss_per_h(self, prices: CutPrices, cuts_per_h: float) -> float:
        """Su of `HourPrices`, at `cuts_per_h` on the mean, pauses included."""
        require_not_negative("cut risks: cuts_per_h", cuts_per_h)
        return cuts_per_h * self.loss_per_cut(prices)


ASSUMED_RISKS = CutRisks(overspeed=0.12, other_track=1.0)
"""P1 and P2 of [hump-computer-1970s], from its own simulation of an unnoticed failure; how it failed is not told."""
