"""The polynomial lines of one aim: solved, fitted, polished; nothing else of a tune."""

from __future__ import annotations

from dataclasses import replace

from synth.problem.aim import Aim
from synth.solver.backward_induction import Solution, solve
from synth.solver.chain.chain import Chain
from synth.solver.evaluation import Evaluation
from synth.solver.policy_density import density_and_occupancy
from synth.solver.polish import Polish, polish
from synth.solver.polynomial_fit import Fit, fit_lines

POLISH_ITERATIONS = 25

FAR_SHARE, MOST_ROUNDS = 0.25, 4
"""A polish ends when a step gains little of the cost that it began with. If it has brought the cost down to less than
this share, that was too early: it is begun anew from its end, so often at most in all."""

DOUBT = 0.02
"""Share of a cost that the errors of the grid of a check may make up."""


def tuned_lines(design: Chain, aim: Aim, degree: int) -> Polish:
    """Polished lines of `degree` for one aim on `design`."""
    solution = solve(design, aim)
    return polished(solution, fitted(solution, degree))


def fitted(solution: Solution, degree: int) -> Fit:
    """Lines of `degree` fitted to a solution, weighted by where its own policy takes the cuts."""
    _, occupancy = density_and_occupancy(solution.chain, solution.lines)
    return fit_lines(solution, occupancy.samples, degree)


def polished(solution: Solution, fit: Fit, check: Chain | None = None) -> Polish:
    """The fitted lines after the polish; several rounds are told as one.

    A long polish may fit the errors of its grid. Where there was more than one round, and another than the last has a
    cost on `check`, another chain of the same plant, that is lower by more than `DOUBT`, its end is taken.
    """
    evaluate, nodes = Evaluation(solution.chain, solution.aim).gradient, solution.chain.grid.path_m
    rounds = [polish(fit.lines, fit.curvature, nodes, evaluate, POLISH_ITERATIONS)]
    while len(rounds) < MOST_ROUNDS and rounds[-1].cost_after < FAR_SHARE * rounds[-1].cost_before:
        rounds.append(polish(rounds[-1].lines, fit.curvature, nodes, evaluate, POLISH_ITERATIONS))
    evaluations, best = sum(each.evaluations for each in rounds), rounds[-1]
    if check is not None and len(rounds) > 1:
        on_check = Evaluation(check, solution.aim)
        costs = [on_check.cost(each.lines.at(check.grid.path_m)) for each in rounds]
        if min(costs) < (1.0 - DOUBT) * costs[-1]:
            best = rounds[costs.index(min(costs))]
    return replace(best, cost_before=rounds[0].cost_before, evaluations=evaluations)
