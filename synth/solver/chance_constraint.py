"""Lines whose probability of over-speed keeps a limit: a Lagrange multiplier, found by bracketing.

The polish minimises mean square + multiplier × P(over-speed), by exact gradients with `PenalisedOverspeed` as terminal
cost; the bracket is closed on the exactly predicted density of the lines with the sensor's staircase. Both take finer
speeds than the rest of a tune: a margin may be no wider than three cells of the check grid, where cubic interpolation
ripples by some thousandths (docs/explanation/choices.md).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from synth.problem.aim import Aim
from synth.problem.requirement import OverspeedLimit
from synth.problem.requirement_found import OverspeedLimitFound
from synth.problem.terminal_cost import PenalisedOverspeed, share_above
from synth.solver.backward_induction import Solution
from synth.solver.chain.chain import Chain
from synth.solver.evaluation import Evaluation
from synth.solver.exit_density import ExitDensity
from synth.solver.finer_speed import finer_in_speed
from synth.solver.policy_density import exit_density
from synth.solver.polish import polish
from synth.solver.polynomial_fit import Fit
from synth.solver.polynomial_lines import PolynomialLines

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
