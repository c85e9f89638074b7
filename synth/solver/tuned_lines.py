"""The polynomial lines of one aim: solved, fitted, polished; nothing else of a tune."""

from __future__ import annotations

import math
from dataclasses import replace

from synth.problem.aim import Aim
from synth.solver.backward_induction import Solution, solve
from synth.solver.chain.chain import Chain
from synth.solver.descent import Descent
from synth.solver.evaluation import Evaluation, Gradient
from synth.solver.policy_density import density_and_occupancy, exit_density
from synth.solver.polish import Evaluate, polish
from synth.solver.polynomial_fit import Fit, fit_lines
from synth.solver.polynomial_lines import PolynomialLines
from synth.solver.switching_lines import SwitchingLines, always_up

POLISH_ITERATIONS, POLISH_TOLERANCE = 25, 5e-3

FAR_SHARE, MOST_ROUNDS = 0.5, 6
"""A polish ends when a step gains little of the avoidable cost that it began with. If it has brought that down to less
than this share, that was too early: it is begun anew from its end, so often at most in all."""

PRICED_TOLERANCE = 0.1
"""Part of the tolerance where a second has a price: rms and time change little against each other along wide valleys.
150 t to 3 m/s at 1e-4 m²/s³: rms 1.125 of that without price at the whole tolerance, 1.012 to 1.023 at 0.06 and 0.2 of
it, the pass 6 % shorter in all."""

LEAST_SHARE = 0.01
"""Of a cost, however dear time is, and however many cuts saturate the brake."""


def tuned_lines(design: Chain, aim: Aim, degree: int, tolerance: float = POLISH_TOLERANCE) -> Descent[PolynomialLines]:
    """Polished lines of `degree` for one aim on `design`; `tolerance` as of `polished`."""
    solution = solve(design, aim)
    return polished(solution, fitted(solution, degree), tolerance)


def fitted(solution: Solution, degree: int) -> Fit:
    """Lines of `degree` fitted to a solution, weighted by where its own policy takes the cuts."""
    _, occupancy = density_and_occupancy(solution.chain, solution.lines)
    return fit_lines(solution, occupancy.samples, degree)


def polished(solution: Solution, fit: Fit, tolerance: float = POLISH_TOLERANCE) -> Descent[PolynomialLines]:
    """The fitted lines after the polish; several rounds are told as one.

    `tolerance` is of the cost that lines can avoid, a part of that where time has a price: not of what cuts cost that
    saturate the brake. Where these rule the mean, the others would be left unpolished.
    """
    chain, aim = solution.chain, solution.aim
    evaluate, nodes = remembering(Evaluation(chain, aim).gradient), chain.grid.path_m
    unavoidable = cost_at_full_brake(chain, aim)

    def avoidable(lines: PolynomialLines) -> float:
        at = lines.at(nodes)
        error = (Evaluation(chain, aim.timeless).gradient if aim.prices_time else evaluate)(at)[0]
        return max(error - unavoidable, LEAST_SHARE * evaluate(at)[0])

    wanted = tolerance * (PRICED_TOLERANCE if aim.prices_time else 1.0)
    rounds: list[Descent[PolynomialLines]] = []
    lines, left = fit.lines, avoidable(fit.lines)
    before = math.inf
    while len(rounds) < MOST_ROUNDS and left < FAR_SHARE * before:
        before, cost = left, evaluate(lines.at(nodes))[0]
        rounds.append(polish(lines, fit.curvature, nodes, evaluate, POLISH_ITERATIONS, wanted * before / cost))
        lines = rounds[-1].best
        left = avoidable(lines)
    evaluations = sum(each.evaluations for each in rounds)
    return replace(rounds[-1], cost_before=rounds[0].cost_before, evaluations=evaluations)


def cost_at_full_brake(chain: Chain, aim: Aim) -> float:
    """What cuts cost that leave too fast with the highest stage all the way: no lines avoid it."""
    density = exit_density(chain, always_up(chain.grid.path_m, chain.plant.top_stage + 1))
    too_fast = density.speed_m_s > aim.target_speed_m_s
    cost = aim.criterion.terminal.at_exit(density.speed_m_s, aim.target_speed_m_s)
    found = (1.0 - sum(share for share, _ in chain.other_days)) * float(density.probability[too_fast] @ cost[too_fast])
    return found + sum(share * cost_at_full_brake(day, aim) for share, day in chain.other_days)


def remembering(evaluate: Evaluate) -> Evaluate:
    """The same, asked once only for the same lines: a round begins with the lines with which the one before ended."""
    known: dict[bytes, Gradient] = {}

    def answer(lines: SwitchingLines) -> Gradient:
        key = lines.lower_m_s.tobytes() + lines.upper_m_s.tobytes()
        if key not in known:
            known[key] = evaluate(lines)
        return known[key]

    return answer
