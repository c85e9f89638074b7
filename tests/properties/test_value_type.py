"""What float32 values cost: lines, gains and exact figures beside those of float64."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant
from synth.problem.aim import Aim
from synth.problem.criterion import Criterion
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import Solution, solve_all
from synth.solver.chain.chain import persistent_chain
from synth.solver.evaluation import Evaluation

TARGETS = (1.0, 2.5, 4.0)


@pytest.fixture(scope="module", params=[0.0, 1e-5], ids=["free", "priced"])
def pairs(
    request: pytest.FixtureRequest, plant_with: Callable[..., Plant], coarse: Resolution
) -> list[tuple[Solution, Solution]]:
    """Solutions in float32 and in float64; the last path quantum is too short for any change of stage."""
    design = persistent_chain(plant_with(), replace(coarse, path_step_m=0.25))
    aims = [Aim(target, Criterion(1.0, request.param)) for target in TARGETS]
    return list(zip(*(solve_all(design, aims, value_type=kind) for kind in (np.float32, np.float64)), strict=True))


def test_values_are_those_of_float64_but_for_some_roundings(pairs: list[tuple[Solution, Solution]]) -> None:
    for single, double in pairs:
        assert (single.values.dtype, double.values.dtype) == (np.dtype(np.float32), np.dtype(np.float64))
        error = np.abs(single.values - double.values)
        assert 0.0 < error.max() < 2e-6 * double.values.max()


def test_lines_are_those_of_float64(pairs: list[tuple[Solution, Solution]]) -> None:
    """There are none more: rounding alone sends no command where nothing can be gained.

    They agree to 0.1 mm/s, but for the last quantum, where hardly anything can be gained on either side of a line.
    """
    for single, double in pairs:
        sides = (
            (single.lines.lower_m_s, double.lines.lower_m_s),
            (single.lines.upper_m_s, double.lines.upper_m_s),
        )
        for one, other in sides:
            there = np.isfinite(other)
            assert there.sum() > 20
            np.testing.assert_array_equal(np.isfinite(one), there)
            matters = there & (np.arange(one.shape[1]) < one.shape[1] - 2)
            assert np.abs(one[matters] - other[matters]).max() < 1e-4


def test_the_policy_costs_what_that_of_float64_does(pairs: list[tuple[Solution, Solution]]) -> None:
    """Evaluated exactly, in float64."""
    for single, double in pairs:
        cost, best = (
            Evaluation(t, each.aim).gradient(each.lines)[0] for each in (single, double) for t in (each.chain,)
        )
        assert abs(cost - best) < 1e-7 * best + 1e-10
