"""The solver against the Bellman equation in plain loops."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models import DopplerSensor, Friction, Plant, RollingResistance
from synth.problem.criterion import Criterion
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import persistent_chain
from tests.effort import every
from tests.oracles.brute_force import BruteForce

TINY = Resolution(
    path_step_m=0.5, speed_step_m_s=0.14, transient_substeps=3, friction_nodes=2, path_levels=2, resistance_nodes=1
)
"""11 quanta × 25 speeds × 2 scenarios × 2 levels."""


def noisy(plant_with: Callable[..., Plant], stages_kpa: tuple[float, ...], period_s: float, w_std: float) -> Plant:
    """Everything random, and a waiting of several quanta if the period is long."""
    return plant_with(
        stages_kpa=stages_kpa,
        friction=Friction(0.12, 0.05, 0.10, 1.5),
        resistance=RollingResistance(2.0, w_std),
        sensor=DopplerSensor(0.06, 0.04, period_s, 0.02),
    )


@pytest.mark.requirement("PRED-01")
@pytest.mark.parametrize(
    ("stages_kpa", "period_s", "target_m_s", "price", "time_price", "w_std"),
    every(
        2,
        [
            ((0.0, 300.0), 0.25, 2.2, 1e-5, 0.0, 0.0),
            ((0.0, 200.0, 400.0), 0.1, 2.6, 0.0, 0.0, 0.0),
            ((0.0, 150.0, 300.0), 0.3, 1.2, 1e-3, 0.1, 0.8),
            ((0.0, 150.0, 300.0), 0.3, 1.2, 1e-3, 0.0, 0.8),
            ((0.0, 200.0, 400.0), 0.1, 1.0, 0.0, 0.02, 0.0),
        ],
    ),
)
def test_solve_agrees_with_plain_loops(
    plant_with: Callable[..., Plant],
    stages_kpa: tuple[float, ...],
    period_s: float,
    target_m_s: float,
    price: float,
    time_price: float,
    w_std: float,
) -> None:
    """The same lines and values to 1e-9: only the order of additions differs."""
    resolution = TINY if w_std == 0.0 else replace(TINY, resistance_nodes=2)
    t = persistent_chain(noisy(plant_with, stages_kpa, period_s, w_std), resolution)
    criterion = Criterion(switching_tolerance_m2_s2=price, time_price_m2_s3=time_price)
    found = solve(t, Aim(target_m_s, criterion), np.float64)
    expected = BruteForce(t, target_m_s, criterion)
    values = array_of(expected)
    assert np.isfinite(values).all()
    np.testing.assert_allclose(found.values, values, rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.lines.lower_m_s[:, :-1].T, expected.lower, rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.lines.upper_m_s[:, :-1].T, expected.upper, rtol=0, atol=1e-9)
    assert np.isfinite(found.lines.upper_m_s[0]).sum() > 5  # the comparison is not about empty lines


def array_of(brute: BruteForce) -> NDArray[np.float64]:
    """Values (I, N + 1, H, L, E)."""
    nodes = range(brute.nodes + 1)
    return np.array([
        [[[brute.value[i, n, h, u] for u in brute.levels] for h in brute.modes] for n in nodes] for i in brute.scenarios
    ])  # fmt: skip
