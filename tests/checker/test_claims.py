"""Which figures of a table the coarse simulation confirms, by figures of passes that leave nothing to chance."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from synth.checker.claims import PredictionRatio, simulated_faults
from synth.checker.statistics import ExitFigures

PASSES, RMS_M_S = 1000, 0.1


def sure_figures() -> ExitFigures:
    """The same error in each pass, as often too fast as too slow."""
    square = RMS_M_S**2
    return ExitFigures(
        weights=(1.0,) * PASSES,
        squares=(square,) * PASSES,
        mean_square=square,
        square_std=0.0,
        bias_m_s=0.0,
        error_std=RMS_M_S,
        plain=PASSES,
        over=0,
        stalls=0,
        switchings=3.0,
        switchings_std=0.0,
    )


@pytest.mark.parametrize(
    ("predicted_of_simulated", "told"), [(0.7, "more than"), (0.8, ""), (1.0, ""), (1.3, ""), (1.5, "less than")]
)
def test_a_predicted_rms_may_be_off_as_far_as_the_configuration_allows(
    predicted_of_simulated: float, told: str
) -> None:
    claims = SimpleNamespace(
        predicted_rms_m_s=predicted_of_simulated * RMS_M_S,
        validated_rms_m_s=None,
        predicted_passes=None,
        bias_m_s=0.0,
        switchings=3.0,
        p_overspeed=0.0,
        p_stall=None,
    )
    found = list(simulated_faults(claims, sure_figures(), PredictionRatio(0.8, 1.3)))
    assert len(found) == bool(told)
    assert all(sentence.startswith("the predicted rms is") and told in sentence for sentence in found)
