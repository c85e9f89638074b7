"""Losses of a year, by hand."""

from __future__ import annotations

import pytest

from synth.computer.reliability.failure_losses import HourPrices, yearly_loss
from synth.computer.reliability.four_states import StateShares


def test_losses_of_a_year_by_hand() -> None:
    loss = yearly_loss(StateShares(0.9, 0.01, 0.06, 0.03), HourPrices(unnoticed=5.0, by_hand=0.5))
    assert loss.unnoticed == pytest.approx(438.0)
    assert loss.maintenance == pytest.approx(262.8)
    assert loss.repair == pytest.approx(131.4)
    assert loss.total == pytest.approx(832.2)
