"""Failures of a common cause in two computers, against the mean of what they are after each hour."""

from __future__ import annotations

from math import expm1

import pytest
from scipy.integrate import quad

from synth.computer.reliability.upkeep import Upkeep
from synth.frame.settings.changed import changed


@pytest.mark.parametrize("common_share", [0.0, 0.1, 0.7, 1.0])
@pytest.mark.parametrize(("failure_per_h", "period_h"), [(1e-5, 24.0), (0.01, 60.0), (0.01, 600.0)])
def test_two_computers_with_a_common_cause(failure_per_h: float, period_h: float, common_share: float) -> None:
    """Checks that take no time: none is ready after a common cause, or when each has failed for itself."""
    asked = changed(
        Upkeep(),
        failure_per_h=failure_per_h, check_interval_h=period_h, check_h=1e-5, common_share=common_share,
    )  # fmt: skip

    def none_ready(hours: float) -> float:
        together = -expm1(-common_share * failure_per_h * hours)
        alone = -expm1(-(1.0 - common_share) * failure_per_h * hours)
        return together + (1.0 - together) * alone**2

    expected, _ = quad(none_ready, 0.0, period_h, epsabs=0.0, epsrel=1e-10)
    assert asked.duplex_unavailability == pytest.approx(expected / period_h, rel=1e-5, abs=1e-9)
