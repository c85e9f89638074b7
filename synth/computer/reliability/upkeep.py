"""One computer or two, how they fail, how they are looked after, and what that costs in a year."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from pydantic import model_validator

from plant_models.errors import require
from plant_models.library.sourced_value import JUDGEMENT
from synth.computer.origins import MONEY
from synth.computer.reliability.four_states import (
    HOURS_PER_YEAR,
    FourStates,
    HourPrices,
    State,
    YearlyLoss,
    yearly_loss,
)
from synth.computer.reliability.maintenance import Duplex
from synth.frame.settings.section import Section, choice, setting

if TYPE_CHECKING:
    from synth.computer.reliability.maintenance import CheckedComputer


class Upkeep(Section):
    """How the computer fails and is looked after."""

    structure: Literal["single", "duplex"] = choice("duplex", "one computer or two")
    failure_per_h: float = setting(
        0.0024, "1/h", 1e-9, 10.0, "failures of one computer that nobody notices at once",
        f"{JUDGEMENT}: makes the published losses of one computer; modern ones fail far less",
    )  # fmt: skip
    detection_per_h: float = setting(
        0.0, "1/h", 0.0, 1e6, "rate at which a computer notices its failure by itself", f"{JUDGEMENT}: it does not"
    )
    check_interval_h: float = setting(2.5, "h", 1e-3, 1e5, "hours between two checks", f"{MONEY}: 2 to 3 h")
    check_h: float = setting(
        0.02, "h", 1e-5, 1e3, "hours of a check, with what it finds", f"{JUDGEMENT}: about a minute"
    )
    repair_h: float = setting(1.0, "h", 1e-4, 1e4, "hours of a repair", f"{JUDGEMENT}: spare boards at hand")
    failed_check_to: Literal["maintenance", "repair"] = choice(
        "maintenance", "where a check of a failed computer leads; the source has it maintenance"
    )
    common_share: float = setting(
        0.05, "1", 0.0, 1.0, "share of failures that hit both computers at once", f"{JUDGEMENT}: 0.01 to 0.1 are usual"
    )
    required_availability: float = setting(
        0.9999,
        "1",
        0.01,
        0.999999,
        "share of the time in which a computer must be ready",
        f"{JUDGEMENT}: an hour in a year",
    )  # fmt: skip
    unnoticed_per_h: float = setting(
        5000.0, "currency/h", 0.0, 1e12, "loss of an hour in which nobody knows of the failure",
        f"{JUDGEMENT}: between a first and a second position that stay released (study control-computer)",
    )  # fmt: skip
    by_hand_per_h: float = setting(
        500.0, "currency/h", 0.0, 1e12, "loss of an hour of humping by hand", f"{JUDGEMENT}: humping is slower"
    )

    @model_validator(mode="after")
    def _possible(self) -> Upkeep:
        require(
            self.check_interval_h >= self.check_h,
            f"check_interval_h is {self.check_interval_h:g} h; it must not be shorter than the check, "
            f"{self.check_h:g} h",
        )
        return self

    @property
    def chain(self) -> FourStates:
        """One computer by itself, checks at random times."""
        return FourStates(
            failure_per_h=self.failure_per_h,
            detection_per_h=self.detection_per_h,
            check_per_h=1.0 / self.check_interval_h,
            maintenance_per_h=1.0 / self.check_h,
            repair_per_h=1.0 / self.repair_h,
            failed_check_to=State[self.failed_check_to.upper()],
        )

    @property
    def checked(self) -> CheckedComputer | None:
        """One computer with checks at even times; None where an hour costs nothing, so no interval is best."""
        from synth.computer.reliability.maintenance import CheckedComputer

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
        return self.single_loss().total if self.structure == "single" else self.duplex_loss_per_year()
