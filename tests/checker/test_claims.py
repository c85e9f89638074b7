"""The figures of passes, and which figures of a table they confirm, by passes that leave nothing to chance."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from synth.checker.claims import PredictionRatio, simulated_faults
from synth.checker.coarse_simulation import Passes
from synth.checker.statistics import ExitFigures, figures_of
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.passes import ExitSample

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


@pytest.mark.requirement("VERIFY-06")
def test_the_figures_of_the_same_passes_are_those_of_the_tool() -> None:
    """Exits every millimetre a second from 1 m/s too slow to 1 m/s too fast, after some cuts that stop."""
    exits_m_s = np.concatenate([np.zeros(99), 3.0 + np.linspace(-1.0, 1.0, 2001)])
    stalled, switchings = exits_m_s == 0.0, np.arange(len(exits_m_s), dtype=np.int32) % 7
    ones = np.ones(len(exits_m_s))
    columns = (exits_m_s, stalled, switchings, ones, ones == 1.0)
    found = figures_of(Passes(*(tuple(column.tolist()) for column in columns)), 3.0)
    own = exit_statistics(ExitSample(exits_m_s, stalled, switchings, 9.0 * ones, ones), 3.0)
    shares = found.over / found.plain, found.stalls / found.plain
    assert shares == pytest.approx((own.overspeed, own.stalled))
    assert (found.rms_m_s, found.bias_m_s) == pytest.approx((own.rms_m_s, own.bias_m_s))
    assert found.switchings == pytest.approx(own.switchings)
