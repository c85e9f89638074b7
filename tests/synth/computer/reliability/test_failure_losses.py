"""Losses of a year and of a cut, by hand; what they refuse."""

from __future__ import annotations

import pytest

from plant_models import PlantError
from synth.computer.reliability.failure_losses import (
    ASSUMED_RISKS,
    CutPrices,
    CutRisks,
    HourPrices,
    yearly_loss,
)
from synth.computer.reliability.four_states import StateShares


def test_losses_of_a_year_by_hand() -> None:
    loss = yearly_loss(StateShares(0.9, 0.01, 0.06, 0.03), HourPrices(unnoticed=5.0, by_hand=0.5))
    assert loss.unnoticed == pytest.approx(438.0)
    assert loss.maintenance == pytest.approx(262.8)
    assert loss.repair == pytest.approx(131.4)
    assert loss.total == pytest.approx(832.2)


def test_loss_of_a_cut_by_hand() -> None:
    """0.12·100·0.25 + 1·7."""
    prices = CutPrices(damage=100.0, re_sorting=7.0, damaged_share=0.25)
    assert (ASSUMED_RISKS.overspeed, ASSUMED_RISKS.other_track) == (0.12, 1.0)
    assert ASSUMED_RISKS.loss_per_cut(prices) == pytest.approx(10.0)
    assert ASSUMED_RISKS.loss_per_h(prices, 150.0) == pytest.approx(1500.0)


def test_impossible_values_are_refused() -> None:
    with pytest.raises(PlantError, match="hour prices: by_hand is -1"):
        HourPrices(1.0, -1.0)
    with pytest.raises(PlantError, match=r"cut risks: overspeed is 1\.2"):
        CutRisks(1.2, 0.5)
    with pytest.raises(PlantError, match="damaged_share is 2"):
        CutPrices(1.0, 1.0, 2.0)
    with pytest.raises(PlantError, match="cuts_per_h is -1"):
        ASSUMED_RISKS.loss_per_h(CutPrices(1.0, 1.0, 0.5), -1.0)
