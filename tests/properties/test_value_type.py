"""What float32 values cost: lines, gains and exact figures beside those of float64."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from synth.dynamic_programme.backward_induction import Solution, solve_all
from synth.dynamic_programme.policy_evaluation import commands, cost_and_gradient
from synth.markov_chain.transitions import Transitions
from synth.problem import Criterion

TARGETS = (1.0, 2.5, 4.0)


@pytest.fixture(scope="module", params=[0.0, 1e-5], ids=["free", "priced"])
def pairs(request: pytest.FixtureRequest, small: Callable[[], Transitions]) -> list[tuple[Solution, Solution]]:
    """Solutions in float32 and in float64."""
    aims = [(target, Criterion(1.0, request.param)) for target in TARGETS]
    return list(zip(*(solve_all(small(), aims, value_type=kind) for kind in (np.float32, np.float64)), strict=True))


def test_values_are_those_of_float64_but_for_some_roundings(pairs: list[tuple[Solution, Solution]]) -> None:
    for single, double in pairs:
        assert (single.values.dtype, double.values.dtype) == (np.float32, np.float64)
        error = np.abs(single.values - double.values)
        assert 0.0 < error.max() < 2e-6 * double.values.max()


def test_lines_are_those_of_float64(pairs: list[tuple[Solution, Solution]]) -> None:
    """To 0.1 mm/s; a line is missing in one of the two at most where nothing can be gained any more."""
    for single, double in pairs:
        sides = (
            (single.lines.lower_m_s, double.lines.lower_m_s, double.gain_down),
            (single.lines.upper_m_s, double.lines.upper_m_s, double.gain_up),
        )
        for one, other, gain in sides:
            both = np.isfinite(one) & np.isfinite(other)
            assert both.sum() > 20
            assert np.abs(one[both] - other[both]).max() < 1e-4
            alone = (np.isfinite(one) != np.isfinite(other))[:, :-1]
            for stage, node in np.argwhere(alone):
                assert gain[node, stage].max() < 4e-6 * double.values.max()


def test_the_policy_costs_what_that_of_float64_does(pairs: list[tuple[Solution, Solution]]) -> None:
    """Evaluated exactly, in float64."""
    for single, double in pairs:
        cost, best = (
            cost_and_gradient(t, commands(t, each.lines, staircase=False), each.target_speed_m_s, each.criterion)[0]
            for each in (single, double)
            for t in (each.transitions,)
        )
        assert abs(cost - best) < 1e-7 * best + 1e-10
