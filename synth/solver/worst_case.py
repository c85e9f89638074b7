"""Lines for the worst friction of a range: the largest of the exact costs by friction factor is made small.

Reweighting in the small: the smooth maximum log(mean exp(β·J_i))/β of the exact costs J_i is polished, whose gradient
is that of the mean under the weights w_i ∝ exp(β·J_i), for growing β. A line search on one smooth function stands
in place of alternating between weights and lines, so nothing can oscillate. At the end the weights are a certificate:
min over lines of Σ w_i·J_i is at most the least possible largest cost (weak duality), so the gap between it and
the largest cost reached bounds what better lines could gain, as far as the two polishes that look for that minimum
find it: the cost is not convex in the lines.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.problem.requirement import FrictionRange
from synth.problem.requirement_found import CERTIFIED_GAP, WorstCaseFound
from synth.solver.backward_induction import Solution
from synth.solver.chain.chain import Chain
from synth.solver.chance_constraint import predicted_density
from synth.solver.evaluation import Evaluation, Gradient, ScenarioCosts
from synth.solver.finer_speed import finer_in_speed, known_factors
from synth.solver.policy_density import scenario_densities
from synth.solver.polish import Evaluate, polish
from synth.solver.polynomial_fit import Fit
from synth.solver.polynomial_lines import PolynomialLines
from synth.solver.switching_lines import SwitchingLines

POLISH_FINER = 2.0
"""The speed step of the design grid is divided by this."""

FACTORS, CHECK_FACTORS = 5, 13
"""Friction factors of the range that are optimised over, and those that the result is predicted on."""

RESISTANCE_NODES, CHECK_RESISTANCE_NODES = 2, 3
"""Gauss nodes of the running resistance at every factor."""

SHARPNESS = (4.0, 16.0, 64.0, 256.0)
"""β times the largest cost, stage by stage; the smooth maximum then lies within log(5)/256 = 0.6 % of the largest."""

ROUNDS = 3
"""The whole is repeated from the lines of the lower bound while the gap is open; the best lines are kept."""

GUARD_ITERATIONS, GUARD_TOLERANCE = 40, 1e-4


def guard_worst_case(
    solution: Solution, check: Chain, fit: Fit, start: PolynomialLines, friction: FrictionRange
) -> tuple[PolynomialLines, WorstCaseFound]:
    """The lines found of least worst rms as predicted on the check grid, and what that took.

    `start`: the lines of least mean cost; `fit`: where they came from. Cost and rms at a factor are means over the
    running resistance. The result is never worse than `start`: a polish can live off the errors of its own grid.
    """
    design, target_speed_m_s = solution.chain, solution.aim.target_speed_m_s
    factors = friction.factors(FACTORS)
    ground = finer_in_speed(design, POLISH_FINER, known_factors(design.plant, factors, RESISTANCE_NODES))
    known = known_factors(check.plant, friction.factors(CHECK_FACTORS), CHECK_RESISTANCE_NODES)
    judge, nodes = replace(check, scenarios=known), ground.grid.path_m
    weight = FACTORS * ground.scenarios.weight.reshape(FACTORS, -1)

    def costs_of(lines: SwitchingLines) -> ScenarioCosts:
        return Evaluation(ground, solution.aim).scenario_costs(lines).grouped(weight)

    def lowered(lines: PolynomialLines) -> PolynomialLines:
        for sharpness in SHARPNESS:
            evaluate = smooth_maximum(costs_of, sharpness / float(costs_of(lines.at(nodes)).cost.max()))
            lines = polish(lines, fit.curvature, nodes, evaluate, GUARD_ITERATIONS, GUARD_TOLERANCE).best
        return lines

    def bounded(lines: PolynomialLines) -> tuple[PolynomialLines, Floats, float]:
        costs = costs_of(lines.at(nodes)).cost
        weights = soft_weights(costs, SHARPNESS[-1] / float(costs.max()))
        mean = weighted_mean(costs_of, weights)
        found = [polish(at, fit.curvature, nodes, mean, GUARD_ITERATIONS, GUARD_TOLERANCE) for at in (lines, start)]
        lowest = min(found, key=lambda each: each.cost_after)
        return lowest.best, weights, 1.0 - lowest.cost_after / float(costs.max())

    before = worst_predicted(judge, start, target_speed_m_s)
    best, worst, begin, (weights, gap) = start, before, start, (np.full(FACTORS, np.nan), np.nan)
    for _ in range(ROUNDS):
        lines = lowered(begin)
        begin, of_lines, open_gap = bounded(lines)
        predicted = worst_predicted(judge, lines, target_speed_m_s)
        if predicted < worst:
            best, worst, weights, gap = lines, predicted, of_lines, open_gap
        if open_gap <= CERTIFIED_GAP:
            break
    return best, WorstCaseFound(
        friction=friction,
        worst_rms_m_s=worst[0],
        worst_rms_without_m_s=before[0],
        worst_factor=worst[1],
        rms_m_s=predicted_density(check, best).rms_m_s(target_speed_m_s),
        rms_without_m_s=predicted_density(check, start).rms_m_s(target_speed_m_s),
        factors=tuple(factors.tolist()),
        weights=tuple(weights.tolist()),
        gap=float(gap),
    )


def weighted_mean(costs_of: Callable[[SwitchingLines], ScenarioCosts], weights: Floats) -> Evaluate:
    """Σ w_i·J_i with its gradient."""

    def evaluate(lines: SwitchingLines) -> Gradient:
        return costs_of(lines).weighted(weights)

    return evaluate


def smooth_maximum(costs_of: Callable[[SwitchingLines], ScenarioCosts], beta: float) -> Evaluate:
    """log(mean exp(β·J_i))/β with its gradient: between the mean and the maximum of the costs."""

    def evaluate(lines: SwitchingLines) -> Gradient:
        costs = costs_of(lines)
        top = costs.cost.max()
        value = top + np.log(np.exp(beta * (costs.cost - top)).mean()) / beta
        return float(value), costs.weighted(soft_weights(costs.cost, beta))[1]

    return evaluate


def soft_weights(cost: Floats, beta: float) -> Floats:
    """Weights ∝ exp(β·cost), which sum to one."""
    raw = np.exp(beta * (cost - cost.max()))
    weights: Floats = raw / raw.sum()
    return weights


def worst_predicted(judge: Chain, lines: PolynomialLines, target_speed_m_s: float) -> tuple[float, float]:
    """(largest predicted rms in m/s, its friction factor) over the `CHECK_FACTORS` factors of `judge`."""
    scenarios = judge.scenarios
    rms = [each.rms_m_s(target_speed_m_s) for each in scenario_densities(judge, lines.at(judge.grid.path_m))]
    share = CHECK_FACTORS * scenarios.weight
    squares = (share * np.array(rms) ** 2).reshape(CHECK_FACTORS, -1).sum(axis=1)
    worst = int(np.argmax(squares))
    return float(np.sqrt(squares[worst])), float(scenarios.factor.reshape(CHECK_FACTORS, -1)[worst, 0])
