"""Passes leave their memory as they found it, so that no evaluation knows of those before it."""

from __future__ import annotations

import numpy as np
import pytest

from plant_models import Plant
from synth.problem.aim import Aim
from synth.problem.any_time_resolution import design_resolution
from synth.problem.criterion import Criterion
from synth.solver.any_time.sampled_chain import SampledChain, sampled_chain
from synth.solver.any_time.surface_evaluation import SurfaceEvaluation
from synth.solver.any_time.surface_polish import NEGLIGIBLE_MASS

AIM = Aim(3.0, Criterion())


@pytest.fixture(scope="module")
def chain(plant: Plant) -> SampledChain:
    return sampled_chain(plant, design_resolution(plant, 3.0, coarser=2.0))


def level_lines(chain: SampledChain, lower_m_s: float, upper_m_s: float) -> np.ndarray:
    """The same two speeds at every node and mode; no command that a mode does not have."""
    lines = np.empty((2, len(chain.drive_m2_s2) - 1, len(chain.modes.stage)))
    lines[0] = np.where(chain.modes.allowed[:, 0], lower_m_s, -np.inf)
    lines[1] = np.where(chain.modes.allowed[:, 2], upper_m_s, np.inf)
    return lines


def test_memory_is_zeros_between_passes(chain: SampledChain) -> None:
    evaluation = SurfaceEvaluation(chain, threads=2)
    evaluation.gradient(level_lines(chain, 3.0, 3.2), AIM)
    evaluation.density(level_lines(chain, 2.0, 4.0))
    assert 1 <= len(evaluation.free) <= 2
    for memory in evaluation.free:
        assert not memory.heading.any()
        assert not memory.here.any()


def test_an_evaluation_after_others_has_the_bits_of_a_first_one(chain: SampledChain) -> None:
    lines, used = level_lines(chain, 3.0, 3.2), SurfaceEvaluation(chain)
    for other in ((1.0, 1.5), (4.0, 6.0)):
        used.gradient(level_lines(chain, *other), AIM)
    again, first = used.gradient(lines, AIM), SurfaceEvaluation(chain).gradient(lines, AIM)
    assert again.cost_m2_s2 == first.cost_m2_s2
    assert np.array_equal(again.slopes, first.slopes)
    assert np.array_equal(again.bends, first.bends)
    assert np.array_equal(used.density(lines).probability, SurfaceEvaluation(chain).density(lines).probability)


def test_leaving_out_more_costs_less_than_a_polish_can_tell(chain: SampledChain) -> None:
    lines = level_lines(chain, 3.0, 3.2)
    exact, coarse = (SurfaceEvaluation(chain, negligible_mass=m).gradient(lines, AIM) for m in (1e-12, NEGLIGIBLE_MASS))
    assert coarse.cost_m2_s2 == pytest.approx(exact.cost_m2_s2, rel=1e-4)
    assert coarse.cost_m2_s2 != exact.cost_m2_s2
