"""One computer or two, how they fail, how they are looked after, and what that costs in a year."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models.errors import require
from synth.configuration.computer.settings import ReliabilitySettings
from synth.yard.control_computer.reliability.duplex import Duplex
from synth.yard.control_computer.reliability.failure_losses import HourPrices, YearlyLoss, yearly_loss
from synth.yard.control_computer.reliability.four_states import FourStates, State
from synth.yard.control_computer.reliability.maintenance_interval import CheckedComputer
from synth.yard.control_computer.reliability.rates import HOURS_PER_YEAR, require_positive


@dataclass(frozen=True)
class Upkeep:
    """Numbers of `ReliabilitySettings`, checked when they are used. `computers`: 1 or 2."""

    failure_per_h: float
    detection_per_h: float
    check_interval_h: float
    check_h: float
    repair_h: float
    common_share: float
    required_availability: float
    unnoticed_per_h: float
    by_hand_per_h: float
    computers: int
    failed_check_to: State

    def __post_init__(self) -> None:
        for key in ("check_interval_h", "check_h", "repair_h"):
            require_positive(f"reliability.{key}", getattr(self, key))
        require(
            self.check_interval_h >= self.check_h,
            f"reliability.check_interval_h is {self.check_interval_h:g} h; it must not be shorter than the check, "
            f"{self.check_h:g} h",
        )
        self.chain, self.duplex, self.prices  # noqa: B018  # their own ranges are checked where they are made

    @property
    def chain(self) -> FourStates:
        """One computer by itself, checks at random times."""
        return FourStates(
            failure_per_h=self.failure_per_h,
            detection_per_h=self.detection_per_h,
            check_per_h=1.0 / self.check_interval_h,
            maintenance_per_h=1.0 / self.check_h,
            repair_per_h=1.0 / self.repair_h,
            failed_check_to=self.failed_check_to,
        )

    @property
    def checked(self) -> CheckedComputer | None:
        """One computer with checks at even times; None where an hour costs nothing, so no interval is best."""
        if min(self.by_hand_per_h, self.unnoticed_per_h) <= 0.0:
            return None
        return CheckedComputer(self.failure_per_h, self.check_h, self.by_hand_per_h, self.unnoticed_per_h)

    @property
    def duplex(self) -> Duplex:
        """Two computers, checked one after the other."""
        return Duplex(self.failure_per_h, self.check_h)

    @property
    def prices(self) -> HourPrices:
        """Of an hour."""
        return HourPrices(self.unnoticed_per_h, self.by_hand_per_h)

    def single_loss(self) -> YearlyLoss:
        """A year with one computer: (p2·Su + (p3 + p4)·Sc)·8760."""
        return yearly_loss(self.chain.stationary(), self.prices)

    @property
    def duplex_unavailability(self) -> float:
        """Mean share of a period without a ready computer: 1 − Kг, and what failures of a common cause add.

        Kг counts the check of one while the other works alone. Of two computers 2e^{−λt} − e^{−(2−β)λt} have a ready
        one after t, so a common share β adds the mean of e^{−(2−β)λt} − e^{−2λt}; checks change that in higher order.
        """
        from scipy.special import exprel

        period, both = self.check_interval_h, 2.0 * self.failure_per_h * self.check_interval_h
        added = float(exprel(-(1.0 - 0.5 * self.common_share) * both) - exprel(-both))
        return 1.0 - float(self.duplex.availability(period)) + added

    def duplex_loss_per_year(self) -> float:
        """A year with two: nobody notices that none is ready."""
        return HOURS_PER_YEAR * self.duplex_unavailability * self.unnoticed_per_h

    def loss_per_year(self) -> float:
        """Of the structure that is asked for."""
        return self.single_loss().total if self.computers == 1 else self.duplex_loss_per_year()


def asked_upkeep(settings: ReliabilitySettings) -> Upkeep:
    """What a configuration asks for."""
    numbers = settings.model_dump(exclude={"structure", "failed_check_to"})
    to = State.MAINTENANCE if settings.failed_check_to == "maintenance" else State.REPAIR
    return Upkeep(**numbers, computers=1 if settings.structure == "single" else 2, failed_check_to=to)
