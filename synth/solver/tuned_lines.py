"""The polynomial lines of one aim: solved, fitted, polished; nothing else of a tune."""

from __future__ import annotations

from dataclasses import replace

from synth.problem.aim import Aim
from synth.solver.backward_induction import Solution, solve
from synth.solver.chain.chain import Chain
from synth.solver.evaluation import Evaluation, Gradient
from synth.solver.policy_density import density_and_occupancy
from synth.solver.polish import Evaluate, Polish, polish
from synth.solver.polynomial_fit import Fit, fit_lines
from synth.solver.switching_lines import SwitchingLines

POLISH_ITERATIONS, POLISH_TOLERANCE = 25, 5e-3

FAR_SHARE, MOST_ROUNDS = 0.25, 4
"""A polish ends when a step gains little of the cost that it began with. If it has brought the cost down to less than
this share, that was too early: it is begun anew from its end, so often at most in all."""

PRICED_TOLERANCE = 0.1
"""Part of the tolerance where a second has a price: rms and time change little against each other along wide valleys.
150 t to 3 m/s at 1e-4 m²/s³: rms 1.125 of that without price at the whole tolerance, 1.012 to 1.023 at 0.06 and 0.2 of
it, the pass 6 % shorter in all."""

LEAST_SHARE = 0.01
"""Of a cost, however dear time is."""

LEAST_ROUNDS_AHEAD = 2
"""With an approach; a single round that ends early has cost up to 3 % of the rms. From the entrance there is one, so
that the tables of before keep every bit."""


def tuned_lines(design: Chain, aim: Aim, degree: int, tolerance: float = POLISH_TOLERANCE) -> Polish:
    """Polished lines of `degree` for one aim on `design`; `tolerance` as of `polished`."""
    solution = solve(design, aim)
    return polished(solution, fitted(solution, degree), tolerance)


def fitted(solution: Solution, degree: int) -> Fit:
    """Lines of `degree` fitted to a solution, weighted by where its own policy takes the cuts."""
    _, occupancy = density_and_occupancy(solution.chain, solution.lines)
    return fit_lines(solution, occupancy.samples, degree)


def polished(solution: Solution, fit: Fit, tolerance: float = POLISH_TOLERANCE) -> Polish:
    """The fitted lines after the polish; several rounds are told as one.

    `tolerance` as of `polish`; a part of it, of the cost without the price of time, where time has one.
    """
    evaluate, nodes = remembering(Evaluation(solution.chain, solution.aim).gradient), solution.chain.grid.path_m
    if solution.aim.prices_time:
        tolerance *= PRICED_TOLERANCE * error_share(evaluate, solution, fit.lines.at(nodes))
    rounds = [polish(fit.lines, fit.curvature, nodes, evaluate, POLISH_ITERATIONS, tolerance)]
    least = LEAST_ROUNDS_AHEAD if solution.chain.approach_nodes else 1
    while len(rounds) < least or (
        len(rounds) < MOST_ROUNDS and rounds[-1].cost_after < FAR_SHARE * rounds[-1].cost_before
    ):
        rounds.append(polish(rounds[-1].lines, fit.curvature, nodes, evaluate, POLISH_ITERATIONS, tolerance))
    evaluations = sum(each.evaluations for each in rounds)
    return replace(rounds[-1], cost_before=rounds[0].cost_before, evaluations=evaluations)


def error_share(evaluate: Evaluate, solution: Solution, lines: SwitchingLines) -> float:
    """How much of the cost of `lines` is not the price of time, of which no polish saves more than a part."""
    timeless = Evaluation(solution.chain, solution.aim.timeless).gradient(lines)[0]
    return max(timeless / evaluate(lines)[0], LEAST_SHARE)


def remembering(evaluate: Evaluate) -> Evaluate:
    """The same, asked once only for the same lines: a round begins with the lines with which the one before ended."""
    known: dict[bytes, Gradient] = {}

    def answer(lines: SwitchingLines) -> Gradient:
        key = lines.lower_m_s.tobytes() + lines.upper_m_s.tobytes()
        if key not in known:
            known[key] = evaluate(lines)
        return known[key]

    return answer
