"""The study of the reserve: what counts as a price, as worse, and as more cuts outside."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from scripts.studies.estimator.reserve_study import excess_outside
from synth.simulation.passes import ExitSample


def sample(exits: NDArray[np.float64]) -> ExitSample:
    n = len(exits)
    return ExitSample(exits, np.zeros(n, dtype=bool), np.zeros(n, dtype=np.int32), np.ones(n), np.full(n, 0.5))


def test_more_outside_is_counted_pass_by_pass_with_its_weight() -> None:
    """Of 1000 passes 40 more are outside, four in every replicate: no chance is left in it."""
    exits = np.full(1000, 3.0)
    exits[::50] = 3.5
    worse = exits.copy()
    worse[7::25] = 2.0
    more, half_width = excess_outside((sample(exits), sample(worse)), 3.0)
    assert more == pytest.approx(0.04)
    assert half_width == pytest.approx(0.0, abs=1e-12)
    assert excess_outside((sample(worse), sample(exits)), 3.0)[0] == pytest.approx(-0.04)
