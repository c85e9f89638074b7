"""The polish of switching speeds: the exactly evaluated cost, minimised over all of them at once."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Bools, Floats
from synth.solver.backward_induction import Solution
from synth.solver.coarse_grid import require_positive
from synth.solver.descent import CostAndSlopes, Descent, descend
from synth.solver.evaluation import Evaluation, Gradient
from synth.solver.one_blas_thread import one_blas_thread
from synth.solver.passage_speeds import PassageSpeeds, ordered, parted_by, passage_speeds
from synth.solver.policy_density import density_and_occupancy
from synth.solver.polynomial_fit import off_line_cost, stage_occupancy

LOOSE_M_S = 0.15
"""Std of a switching speed that costs nothing: it moves no farther than others make it."""


@one_blas_thread()
def polish_passages(solution: Solution, max_iterations: int = 40, tolerance: float = 2e-3) -> Descent[PassageSpeeds]:
    """Minimise the cost over all finite switching speeds of a solution, keeping their order.

    Sequential quadratic programming in units in which being off costs the same for each. It ends when a step changes
    the cost by less than `tolerance` of the first without the price of time; the cost of the result is no higher than
    the start's.

    Raises `CoarseGridError` if the cost to start from is not positive.
    """
    from scipy.optimize import LinearConstraint  # start-up: scipy only where it is needed

    start = passage_speeds(solution.lines_m_s)
    free = np.isfinite(start.switching_m_s)
    evaluation = Evaluation(solution.chain, solution.aim)
    first = evaluation.gradient(start)
    off = np.maximum(being_off(solution, start)[free], 0.0)
    cost = require_positive(first[0], "switching speeds")
    if solution.aim.prices_time:
        tolerance *= Evaluation(solution.chain, solution.aim.timeless).gradient(start)[0] / cost
    unit = np.minimum(np.sqrt(cost / (off + 1e-12)), LOOSE_M_S)

    def policy(y: Floats) -> PassageSpeeds:
        t = np.array(start.switching_m_s)
        t[free] += unit * y
        return PassageSpeeds(ordered(t))

    def by_point(cost_and_slopes: Gradient) -> CostAndSlopes:
        return cost_and_slopes[0], cost_and_slopes[1][free] * unit

    order = order_of(free)
    gaps = order @ start.switching_m_s[free]
    constraints = [LinearConstraint(order * unit, -gaps, np.inf)] if len(order) else []
    found = descend(
        lambda y: by_point(evaluation.gradient(policy(y))), by_point(first), constraints, max_iterations, tolerance
    )
    return found.ending(policy(found.best) if found.best.any() else start, found.cost_after)


def being_off(solution: Solution, speeds: PassageSpeeds) -> Floats:
    """Second derivative of the cost by every switching speed, (M, K + 1, K), about the policy of the solution."""
    _, occupancy = density_and_occupancy(solution.chain, speeds)
    chain = solution.chain
    per_stage = stage_occupancy(occupancy.samples, chain.actuator.mode_stage, chain.actuator.stages)
    found = np.zeros(speeds.switching_m_s.shape)
    for command, stage, parted in parted_by(chain.decisions.commands, chain.actuator.stages):
        gain = solution.gain[command, :, stage]
        if command >= 2:
            gain = gain - solution.gain[command - 2, :, stage]
        line = speeds.switching_m_s[:, stage, parted]
        found[:, stage, parted] = off_line_cost(line, gain, per_stage[:, stage], chain.grid.speed_m_s)
    return found


def order_of(free: Bools) -> Floats:
    """One row for every two neighbours of a row that are both free, over the free ones: their difference."""
    number = np.cumsum(free.ravel()).reshape(free.shape) - 1
    both = free[:, :, 1:] & free[:, :, :-1]
    rows = np.zeros((int(both.sum()), int(free.sum())))
    at = np.arange(len(rows))
    rows[at, number[:, :, 1:][both]] = 1.0
    rows[at, number[:, :, :-1][both]] = -1.0
    return rows
