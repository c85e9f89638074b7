"""The programme of point sensors against plain loops, and its figures against one another."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Friction, Plant, PointSensors, RollingResistance, every_axle, first_axle
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import Solution, solve
from synth.solver.chain.chain import persistent_chain
from synth.solver.chain.sampling import SensorPassages, with_point_sensors
from synth.solver.evaluation import Evaluation, commands_of, forward_all
from synth.solver.passage_speeds import PassageSpeeds, passage_speeds, polish_passages
from tests.oracles.plain_loops import CRITERION, TARGET_M_S, PlainLoops

TINY = Resolution(path_step_m=0.5, speed_step_m_s=0.14, friction_nodes=2, path_levels=2, resistance_nodes=1)
SENSORS = PointSensors(
    (-2.0, 0.6, 2.4), timer_noise_s=3e-3, timer_resolution_s=0.0, scan_period_s=0.05, missed_share=0.15
)


def noisy(plant_with: Callable[..., Plant], sensors: PointSensors) -> Plant:
    """Three stages, everything random."""
    plant = plant_with(friction=Friction(0.12, 0.05, 0.10, 1.5), resistance=RollingResistance(2.0, 0.6))
    return with_point_sensors(plant, sensors)


@pytest.fixture(scope="module", params=[first_axle, every_axle], ids=["first axle", "every axle"])
def solved(request: pytest.FixtureRequest, plant_with: Callable[..., Plant]) -> Solution:
    """A tiny problem, solved in float64."""
    sensors = replace(SENSORS, axles=request.param)
    chain = persistent_chain(noisy(plant_with, sensors), TINY, SensorPassages(sensors))
    return solve(chain, Aim(TARGET_M_S, CRITERION), np.float64)


@pytest.mark.requirement("PRED-01")
def test_solve_agrees_with_plain_loops(solved: Solution) -> None:
    """The same values to 1e-9 and the same lines to 1e-6."""
    plain, t = PlainLoops(solved.chain), solved.chain
    expected = np.array([[[[plain.value[n, i, h, u] for u in range(len(t.path_noise.levels))]
        for h in range(len(t.actuator.mode_stage))] for n in range(plain.nodes + 1)]
        for i in range(len(t.scenarios.factor))])  # fmt: skip
    np.testing.assert_allclose(solved.values, expected, rtol=0, atol=1e-9)
    compared = 0
    for (decision, command), lines in plain.lines.items():
        found = solved.lines_m_s[command, decision]
        for k, line in enumerate(lines):
            if math.isfinite(line):
                at_line = t.measurement.speeds(np.full(solved.lines_m_s.shape, line))[command, decision, k]
                assert found[k] == pytest.approx(at_line, abs=1e-6)
                compared += 1
            elif not math.isnan(line):
                assert found[k] == line
    assert compared >= 10


def test_density_and_value_agree(solved: Solution) -> None:
    """rms² + stall cost + cost of commands by the forward recursion = cost by the backward one without time.

    No mass is lost. On so coarse a grid cubic weights leave stalls of a little less than nothing, so they are taken
    unclipped.
    """
    c, speeds = solved.chain, passage_speeds(solved.lines_m_s)
    scenarios = len(c.scenarios.weight)
    nothing, band = np.empty((scenarios, 0, 0, 0, 0)), np.empty((scenarios, len(c.drive_m_s2), 2), dtype=np.int64)
    exits, totals = forward_all(c, commands_of(c, speeds), slice(None), nothing, band)
    probability_of, (stalled, _, down, up) = c.scenarios.weight @ exits, c.scenarios.weight @ totals
    forward = probability_of @ (c.grid.speed_m_s - TARGET_M_S) ** 2
    forward += stalled * (TARGET_M_S**2 + CRITERION.stall_cost_m2_s2)
    forward += CRITERION.switching_tolerance_m2_s2 * (down + up)
    timeless = Aim(TARGET_M_S, replace(CRITERION, time_price_m2_s3=0.0))
    assert Evaluation(c, timeless).cost(speeds) == pytest.approx(forward, rel=1e-7)
    assert probability_of.sum() + stalled == pytest.approx(1.0, abs=1e-9)


def test_gradient_is_the_slope_of_the_cost(solved: Solution) -> None:
    """Central difference along a random direction of all switching speeds."""
    evaluation, speeds, h = Evaluation(solved.chain, solved.aim), passage_speeds(solved.lines_m_s), 3e-5
    t = speeds.switching_m_s
    apart = np.where(np.isfinite(t), t + 0.02 * np.arange(t.shape[2]), t)  # equal ones would cross
    direction = np.where(np.isfinite(t), np.random.default_rng(3).standard_normal(t.shape), 0.0)
    costs = [evaluation.gradient(PassageSpeeds(apart + by * direction))[0] for by in (h, -h)]
    along = (evaluation.gradient(PassageSpeeds(apart))[1] * direction).sum()
    assert along == pytest.approx((costs[0] - costs[1]) / (2 * h), rel=2e-3, abs=2e-6)
    assert abs(along) > 1e-5


def test_the_polish_lowers_the_cost_and_keeps_the_order(solved: Solution) -> None:
    """What it promises is what an evaluation of the result finds; so small a problem leaves little to gain."""
    found = polish_passages(solved, tolerance=1e-8)
    assert found.cost_after < found.cost_before * (1.0 - 1e-5)
    cost = Evaluation(solved.chain, solved.aim).gradient(found.best)[0]
    assert cost == pytest.approx(found.cost_after, rel=1e-9)
    t = found.best.switching_m_s
    assert (t[:, :, 1:] >= t[:, :, :-1]).all()
