"""Lines that keep what a criterion requires: a limit of the probability of over-speed, or the worst friction.

*Over-speed.* A Lagrange multiplier, found by bracketing. The polish minimises mean square + multiplier × P(over-speed),
by exact gradients with `PenalisedOverspeed` as terminal cost; the bracket is closed on the exactly predicted density of
the lines with the sensor's staircase. Both take finer speeds than the rest of a tune: a margin may be no wider than
three cells of the check grid, where cubic interpolation ripples by some thousandths (docs/explanation/choices.md).

*Worst friction.* The largest of the exact costs by friction factor is made small, by reweighting in the small: the
smooth maximum log(mean exp(β·J_i))/β of the exact costs J_i is polished, whose gradient is that of the mean under the
weights w_i ∝ exp(β·J_i), for growing β. A line search on one smooth function stands in place of alternating between
weights and lines, so nothing can oscillate. At the end the weights are a certificate: min over lines of Σ w_i·J_i is at
most the least possible largest cost (weak duality), so the gap between it and the largest cost reached bounds what
better lines could gain, as far as the two polishes that look for that minimum find it: the cost is not convex in the
lines.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.problem.criterion import PenalisedOverspeed, share_above
from synth.problem.problem import Aim
from synth.problem.requirement import CERTIFIED_GAP, FrictionRange, OverspeedLimit, OverspeedLimitFound, WorstCaseFound
from synth.solver.backward_induction import Solution
from synth.solver.chain.chain import Chain, finer_in_speed, known_factors
from synth.solver.evaluation import Evaluation, Gradient, ScenarioCosts, exit_density, scenario_densities
from synth.solver.exit_density import ExitDensity
from synth.solver.switching_lines import PolynomialLines, SwitchingLines
from synth.solver.tuned_lines import Evaluate, Fit, polish

PRICE_GROWTH = 4.0
MOST_GROWTHS = 8
"""No higher multiplier is tried than 4^8 = 65 536 times the first, at which both terms of the cost are equal."""

MOST_BISECTIONS = 10
CLOSE = 0.95
"""A reached probability from this share of the limit to the limit ends the search."""

FINER = 2.0
"""Speed steps of the design and the check grid are divided by this."""

NARROW = 1.02
"""As does a bracket whose ends differ by less than this factor."""

PRICED_ITERATIONS, PRICED_TOLERANCE = 40, 1e-3


@dataclass(frozen=True)
class Candidate:
    """Lines polished at one price, and what is predicted for them."""

    price_m2_s2: float
    lines: PolynomialLines
    probability: float
    rms_m_s: float


def keep_overspeed_limit(
    solution: Solution, check: Chain, fit: Fit, start: PolynomialLines, limit: OverspeedLimit
) -> tuple[PolynomialLines, OverspeedLimitFound]:
    """The lines of least predicted mean square among those found that keep `limit`, and what that took.

    `start`: the lines of least cost without the limit; `fit`: where they came from. Ends after at most
    `MOST_GROWTHS` + `MOST_BISECTIONS` polishes, whether the limit can be kept or not.
    """
    target_speed_m_s, criterion = solution.aim.target_speed_m_s, solution.aim.criterion
    law = check.scenarios  # few Gauss nodes would miss the rare cuts that make over-speed
    ground, judge = finer_in_speed(solution.chain, FINER, law), finer_in_speed(check, FINER, law)

    def candidate(price: float, *begin: PolynomialLines) -> Candidate:
        priced = replace(criterion.squared(), terminal=PenalisedOverspeed(price, limit.margin_m_s))
        evaluate = Evaluation(ground, Aim(target_speed_m_s, priced)).gradient
        ends = [
            polish(at, fit.curvature, ground.grid.path_m, evaluate, PRICED_ITERATIONS, PRICED_TOLERANCE) for at in begin
        ]
        return judged(price, min(ends, key=lambda end: end.cost_after).best)

    def judged(price: float, lines: PolynomialLines) -> Candidate:
        density = predicted_density(judge, lines)
        above = share_above(density.speed_m_s, target_speed_m_s + limit.margin_m_s)  # the ramp that is priced
        probability = max(float((density.probability * above).sum()), 0.0)
        return Candidate(price, lines, probability, density.rms_m_s(target_speed_m_s))

    highest = limit.highest_probability
    tried = [judged(0.0, start)]
    if tried[0].probability > highest:  # the price is told against lines that were polished as well as the priced ones
        tried = [candidate(0.0, start)]
    if tried[0].probability > highest:
        price = tried[0].rms_m_s ** 2 / tried[0].probability
        while tried[-1].probability > highest and len(tried) <= MOST_GROWTHS:
            tried.append(candidate(price, tried[-1].lines))
            price *= PRICE_GROWTH
        tried += bisected(tried, highest, candidate) if tried[-1].probability <= highest else []
    keeping = [each for each in tried if each.probability <= highest]
    best = min(keeping, key=lambda each: each.rms_m_s) if keeping else min(tried, key=lambda each: each.probability)
    found = OverspeedLimitFound(
        limit=limit,
        multiplier_m2_s2=best.price_m2_s2 if keeping else tried[-1].price_m2_s2,
        probability=best.probability,
        probability_without=tried[0].probability,
        rms_m_s=best.rms_m_s,
        rms_without_m_s=tried[0].rms_m_s,
        met=bool(keeping),
        rounds=len(tried) - 1,
    )
    return best.lines, found


def bisected(tried: list[Candidate], highest: float, candidate: Callable[..., Candidate]) -> list[Candidate]:
    """Candidates at prices between the last too low one and the first sufficient one, geometric means.

    Each is polished from both ends of the bracket, whose better result counts: the cost is not convex in the lines.
    Both ends only move inwards, so the bracket closes even where the probability is not monotone in the price.
    """
    low, high = tried[-2], tried[-1]
    lowest = low.price_m2_s2 or high.price_m2_s2 / PRICE_GROWTH**2
    added: list[Candidate] = []
    while len(added) < MOST_BISECTIONS and high.probability < CLOSE * highest and high.price_m2_s2 > NARROW * lowest:
        middle = candidate(math.sqrt(lowest * high.price_m2_s2), low.lines, high.lines)
        added.append(middle)
        if middle.probability <= highest:
            high = middle
        else:
            low, lowest = middle, middle.price_m2_s2
    return added


def predicted_density(check: Chain, lines: PolynomialLines) -> ExitDensity:
    """Prediction of unrounded lines; rounding to float32 moves a line by less than 1e-6 m/s."""
    return exit_density(check, lines.at(check.grid.path_m))


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
