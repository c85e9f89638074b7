"""How often a case is called better that is not: of one case, and of any of many."""

from __future__ import annotations

import math

import numpy as np
import pytest

from synth.logs.retune.predicted_gain import MOST_FALSE, CaseGain, better, no_better
from synth.simulation.replicates import student_quantile

PLANTS, CASES, FAMILIES = 16, 30, 2000


def gain(number: int, p_value: float) -> CaseGain:
    return CaseGain(f"class {number}", 3.0, 0.05, 0.04, 0.8, (0.7, 0.9), p_value, PLANTS)


def test_a_p_value_belongs_to_the_interval() -> None:
    """It is half of 5 % just where the 95 % interval ends at a ratio of 1."""
    spread = 0.013
    edge = -student_quantile(PLANTS - 1) * spread
    assert no_better(edge, spread, PLANTS - 1) == pytest.approx(0.025, abs=1e-12)
    assert no_better(0.0, spread, PLANTS - 1) == pytest.approx(0.5)
    assert (no_better(-0.1, 0.0, 15), no_better(0.0, 0.0, 15)) == (0.0, 1.0)


def test_of_many_cases_hardly_ever_one_is_called_better_by_chance() -> None:
    """Cases whose true plant gains nothing; each plant of a case is drawn from the law that the true one is from."""
    rng = np.random.default_rng(19)
    logs = rng.normal(size=(FAMILIES, CASES, PLANTS + 1))
    middle = logs[:, :, 1:].mean(axis=2) - logs[:, :, 0]
    spread = logs[:, :, 1:].std(axis=2, ddof=1) * math.sqrt(1.0 + 1.0 / PLANTS)
    p = [
        [no_better(float(m), float(s), PLANTS - 1) for m, s in zip(*row, strict=True)]
        for row in zip(middle, spread, strict=True)
    ]
    one_by_one = np.mean(np.array(p) <= MOST_FALSE)
    assert one_by_one == pytest.approx(MOST_FALSE, abs=4.0 * math.sqrt(MOST_FALSE / (FAMILIES * CASES)))
    called = np.mean([bool(better([gain(i, each) for i, each in enumerate(row)])) for row in p])
    assert called <= MOST_FALSE + 3.0 * math.sqrt(MOST_FALSE / FAMILIES)
    assert np.mean([min(row) <= MOST_FALSE for row in p]) > 0.4, "without the rule it would be seldom too"


def test_cases_that_are_better_are_told_in_their_order() -> None:
    found = better([gain(0, 0.02), gain(1, 0.4), gain(2, 0.001)])
    assert [each.label for each in found] == ["class 2"]  # 0.02 is more than 0.025 / 2
    assert [each.label for each in better([gain(0, 0.012), gain(1, 0.4), gain(2, 0.001)])] == ["class 0", "class 2"]
