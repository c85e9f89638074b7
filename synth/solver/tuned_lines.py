"""The polynomial lines of one case: solved, fitted, polished; nothing else of a tune."""

from __future__ import annotations

from synth.problem.criterion import Criterion
from synth.solver.backward_induction import Solution, solve
from synth.solver.chain.transitions import Transitions
from synth.solver.policy_evaluation import commands, evaluator, occupancy_of
from synth.solver.polynomial_fit import Fit, PolynomialLines, fit_lines, polish

POLISH_ITERATIONS = 25

FAR_SHARE, MOST_ROUNDS = 0.25, 4
"""A polish ends when a step gains little of the cost that it began with. If it has brought the cost down to less than
this share, that was too early: it is begun anew from its end, so often at most in all."""


def tuned_lines(design: Transitions, target_speed_m_s: float, criterion: Criterion, degree: int) -> PolynomialLines:
    """Lines of `degree` for one target speed on `design`."""
    return lines_of_solution(solve(design, target_speed_m_s, criterion), degree)


def lines_of_solution(solution: Solution, degree: int) -> PolynomialLines:
    """Lines of `degree` fitted to a solution, and polished."""
    fit = fitted(solution, degree)
    return polished(solution.transitions, fit, solution.target_speed_m_s, solution.criterion)


def fitted(solution: Solution, degree: int) -> Fit:
    """Lines of `degree` fitted to a solution, weighted by where its own policy takes the cuts."""
    design = solution.transitions
    _, occupancy = occupancy_of(design, commands(design, solution.lines, staircase=False))
    return fit_lines(solution, occupancy.samples, degree)


def polished(design: Transitions, fit: Fit, target_speed_m_s: float, criterion: Criterion) -> PolynomialLines:
    """The fitted lines after the polish."""
    evaluate, nodes = evaluator(design, target_speed_m_s, criterion), design.grid.path_m
    found = polish(fit.lines, fit.curvature, nodes, evaluate, POLISH_ITERATIONS)
    for _ in range(MOST_ROUNDS - 1):
        if found.cost_after >= FAR_SHARE * found.cost_before:
            break
        found = polish(found.lines, fit.curvature, nodes, evaluate, POLISH_ITERATIONS)
    return found.lines
