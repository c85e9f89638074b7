"""Switching speeds at the passages over point sensors, the policy of a regulator that sees a cut only there; and
their polish: the exactly evaluated cost, minimised over all of them at once.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, frozen_arrays
from synth.solver.backward_induction import Solution
from synth.solver.chain.decisions import Decisions, steps_of
from synth.solver.descent import CostAndSlopes, Descent, descend, one_blas_thread, require_positive
from synth.solver.evaluation import Evaluation, Gradient, density_and_occupancy
from synth.solver.tuned_lines import off_line_cost, stage_occupancy

SMALLEST_GAP_M_S = 1e-3
"""A line to go down lies at least so far below the line to go up."""


@frozen_arrays
class PassageSpeeds:
    """`switching_m_s` (M, K + 1, K): at passage m with stage k in force, t[j] parts wanting stage j from stage j + 1.

    No row falls; −∞ for j < k: never lower so far, +∞ for j ≥ k: never raise so far (`programs.at_pulse`).
    """

    switching_m_s: Floats

    def __post_init__(self) -> None:
        t = self.switching_m_s
        if t.ndim != 3 or t.shape[1] != t.shape[2] + 1:
            raise ValueError(f"passage speeds: shape {t.shape}; it must be (passages, stages, stages - 1)")
        if not (t[:, :, 1:] >= t[:, :, :-1]).all():
            raise ValueError("passage speeds: a row falls")

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return int(self.switching_m_s.shape[1])

    def at_decisions(self, decisions: Decisions) -> Floats:
        """The lines (C, R, K + 1) of commands by up to K stages."""
        lines = np.empty((decisions.commands, *self.switching_m_s.shape[:2]))
        lines[0::2], lines[1::2] = -np.inf, np.inf
        for command, stage, parted in parted_by(decisions.commands, self.stages):
            lines[command, :, stage] = self.switching_m_s[:, stage, parted]
        return lines

    def slopes(self, decisions: Decisions, by_command: Floats) -> Floats:
        """Derivatives by the switching speeds, (I, M, K + 1, K)."""
        found = np.zeros((len(by_command), *self.switching_m_s.shape))
        for command, stage, parted in parted_by(decisions.commands, self.stages):
            found[:, :, stage, parted] = by_command[:, command, :, stage]
        return found


def parted_by(commands: int, stages: int) -> Iterator[tuple[int, int, int]]:
    """(command, stage in force, index of the switching speed in its row) of every line that there can be."""
    for command in range(commands):
        step = steps_of(command)
        for stage in range(stages):
            parted = stage + step if step < 0 else stage + step - 1
            if 0 <= parted < stages - 1:
                yield command, stage, parted


def passage_speeds(lines_m_s: Floats) -> PassageSpeeds:
    """The policy of lines (C, R, K + 1); where a line to go down reaches the one to go up, both make room."""
    commands, passages, stages = lines_m_s.shape
    t = np.empty((passages, stages, stages - 1))
    for stage in range(stages):
        t[:, stage, :stage], t[:, stage, stage:] = -np.inf, np.inf
    for command, stage, parted in parted_by(commands, stages):
        t[:, stage, parted] = lines_m_s[command, :, stage]
    return PassageSpeeds(ordered(t))


def ordered(switching_m_s: Floats) -> Floats:
    """(M, K + 1, K) with no row falling and a gap around the stage in force."""
    t = np.array(switching_m_s)
    stages = t.shape[1]
    for stage in range(stages):
        down, up = t[:, stage, :stage], t[:, stage, stage:]
        down[:] = np.minimum.accumulate(down[:, ::-1], axis=1)[:, ::-1] if stage else down
        up[:] = np.maximum.accumulate(up, axis=1) if stage < stages - 1 else up
        if 0 < stage < stages - 1:
            near_down, near_up = down[:, -1:], up[:, :1]
            both = np.isfinite(near_down) & np.isfinite(near_up)
            low, high = np.where(both, near_down, 0.0), np.where(both, near_up, 0.0)
            close = both & (high - low < SMALLEST_GAP_M_S)
            middle = 0.5 * (low + high)
            down[:] = np.where(close, np.minimum(down, middle - 0.5 * SMALLEST_GAP_M_S), down)
            up[:] = np.where(close, np.maximum(up, middle + 0.5 * SMALLEST_GAP_M_S), up)
    return t


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
