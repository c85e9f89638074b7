"""The polynomial lines of one aim: fitted to the solution by what being off the line costs, then polished.

The polish minimises the exactly evaluated cost of the polynomial policy itself over all coefficients at once; its
gradient comes from one forward and one backward pass (`evaluation.Evaluation.gradient`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.problem.problem import Aim
from synth.solver.backward_induction import Solution, solve
from synth.solver.chain.chain import Chain
from synth.solver.descent import CostAndSlopes, Descent, descend, one_blas_thread, require_positive
from synth.solver.evaluation import Evaluation, Gradient, density_and_occupancy, exit_density
from synth.solver.switching_lines import (
    MINIMUM_GAP_M_S,
    PolynomialLines,
    SwitchingLines,
    always_up,
    basis,
    gap_of,
    opened,
)


@frozen_arrays
class Fit:
    """Fitted lines and `curvature` (K + 1, 2, N): second derivative of the cost by every line value."""

    lines: PolynomialLines
    curvature: Floats


@one_blas_thread()
def fit_lines(solution: Solution, occupancy: Floats, degree: int) -> Fit:
    """Weighted least squares; the weight of a node is the curvature of the cost in the line's position there.

    `occupancy` (I, N, H, L, E): expected samples under the solution's own policy. Where a line is never near a
    sample it costs nothing to be off it; a thousandth of the largest weight keeps it near its matrix.
    """
    t = solution.chain
    nodes, stages = t.grid.path_m[:-1], t.actuator.stages
    ends_m = t.plant.start_m, t.plant.exit_m
    has_line = np.ones((stages, 2), dtype=bool)
    has_line[0, 0] = has_line[-1, 1] = False
    matrix = basis(nodes, *ends_m, degree)
    coefficients = np.zeros((stages, 2, degree + 1))
    curvature = np.zeros((stages, 2, len(nodes)))
    per_stage = stage_occupancy(occupancy, t.actuator.mode_stage, stages)
    for k, side in zip(*np.nonzero(has_line), strict=True):
        line = (solution.lines.lower_m_s, solution.lines.upper_m_s)[side][k, :-1]
        gain = (solution.gain_down, solution.gain_up)[side][:, k]
        weight = off_line_cost(line, gain, per_stage[:, k], t.grid.speed_m_s)
        curvature[k, side] = weight
        line = carried_back(line, t.approach_nodes)
        known = np.isfinite(line)
        if not known.any():
            coefficients[k, side, 0] = (0.0, t.grid.speed_m_s[-1])[side]
            continue
        root = np.sqrt(weight[known] + 1e-3 * weight[known].max() + 1e-12)
        coefficients[k, side] = np.linalg.lstsq(matrix[known] * root[:, None], line[known] * root, rcond=None)[0]
    return Fit(opened(PolynomialLines(*ends_m, coefficients, has_line)), curvature)


def carried_back(line: Floats, nodes: int) -> Floats:
    """`line` (N,) with its first finite value in place of infinite ones at the first `nodes`.

    Before the entrance a stage may have no line where it must not be left or is never met. A polynomial that is free
    there would cross its partner, and what keeps the two apart would move both everywhere.
    """
    finite = np.isfinite(line)
    if not finite.any():
        return line
    first = int(np.argmax(finite))
    return np.where((np.arange(len(line)) < min(first, nodes)), line[first], line)


def stage_occupancy(occupancy: Floats, mode_stage: Ints, stages: int) -> Floats:
    """Expected samples by node, stage and speed, (N, K + 1, E)."""
    by_mode = occupancy.sum(axis=(0, 3))
    out = np.zeros((by_mode.shape[0], stages, by_mode.shape[2]))
    for mode, stage in enumerate(mode_stage):
        out[:, stage] += by_mode[:, mode]
    return out


def off_line_cost(line: Floats, gain: Floats, occupancy: Floats, speed_m_s: Floats, window_m_s: float = 0.15) -> Floats:
    """Second derivative of the cost by the line's position at every node, (N,).

    Samples per m/s near the line times the slope of the gain there, both over ±`window_m_s`.
    """
    weight = np.zeros(len(line))
    for n, v in enumerate(line):
        if not np.isfinite(v):
            continue
        low, high = np.searchsorted(speed_m_s, (v - window_m_s, v + window_m_s))
        if high - low < 2:
            continue
        slope = abs(gain[n, high - 1] - gain[n, low]) / (speed_m_s[high - 1] - speed_m_s[low])
        weight[n] = slope * max(occupancy[n, low:high].sum(), 0.0) / (2 * window_m_s)
    return weight


LOOSE_M_S = 0.3
"""See `whitening`."""

Evaluate = Callable[[SwitchingLines], tuple[float, Floats]]
"""Lines at path nodes → (cost, its derivatives by the lower and the upper lines (2, N, K + 1))."""


@one_blas_thread()
def polish(
    start: PolynomialLines,
    curvature: Floats,
    nodes_m: Floats,
    evaluate: Evaluate,
    max_iterations: int,
    tolerance: float = 5e-3,
) -> Descent[PolynomialLines]:
    """Minimise `evaluate` over all coefficients, keeping V_hi − V_lo ≥ `MINIMUM_GAP_M_S` on the path.

    It ends when a step changes the cost by less than `tolerance` of the first cost. The cost of the result is positive
    and no higher than the start's. A negative cost can only come from a grid that is too coarse.

    Raises `CoarseGridError` if the cost to start from is not positive.

    Sequential quadratic programming in coordinates in which the `curvature` (K + 1, 2, N) of `fit_lines` is
    the unit matrix, so that the first steps are Newton steps.
    """
    free, width = np.nonzero(start.has_line), start.degree + 1
    matrix = start.basis(nodes_m)[: curvature.shape[2]]
    first = evaluate(start.at(nodes_m))
    before = require_positive(first[0], "lines")
    scale = whitening(curvature[free], matrix, before)

    def unpack(y: Floats) -> PolynomialLines:
        coefficients = start.coefficients.copy()
        coefficients[free] += np.einsum("lab,lb->la", scale, y.reshape(-1, width))
        return replace(start, coefficients=coefficients)

    def by_point(cost_and_slopes: tuple[float, Floats]) -> CostAndSlopes:
        cost, by_lines = cost_and_slopes
        gradient = np.stack([np.ascontiguousarray(each.T) @ matrix for each in by_lines], axis=1)[free]
        return cost, np.einsum("lab,la->lb", scale, gradient).ravel()

    found = descend(
        lambda y: by_point(evaluate(unpack(y).at(nodes_m))), by_point(first), [gap_constraint(start, free, scale)],
        max_iterations, tolerance, allowed=lambda y: gap_of(unpack(y)) >= 0.5 * MINIMUM_GAP_M_S,
    )  # fmt: skip
    cost, best = found.cost_after, unpack(found.best) if found.best.any() else start
    lines = opened(best)
    if lines is not best:
        cost = evaluate(lines.at(nodes_m))[0]
    if not 0.0 < cost <= before:
        cost, lines = before, start
    return found.ending(lines, cost)


def whitening(curvature: Floats, matrix: Floats, cost: float) -> Floats:
    """Per line the matrix T with Tᵀ·H·T = 1, H the Hessian of cost/`cost` by the line's coefficients.

    `curvature` (lines, N), `matrix` (N, r + 1). A line that nothing depends on is held as if moving it by
    `LOOSE_M_S` everywhere doubled the cost.
    """
    loose = matrix.T @ matrix / (len(matrix) * LOOSE_M_S**2)
    hessian = np.einsum("na,ln,nb->lab", matrix, curvature / cost, matrix) + loose
    lower = np.linalg.cholesky(hessian)
    whitened: Floats = np.linalg.inv(lower).transpose(0, 2, 1)
    return whitened


def gap_constraint(lines: PolynomialLines, free: tuple[Ints, ...], scale: Floats) -> dict[str, Any]:
    """Linear inequality V_hi,k(s) − V_lo,k(s) − gap ≥ 0 at points along the path, for SLSQP."""
    points = lines.nodes_m(13)
    matrix = lines.basis(points)
    index = {(int(k), int(side)): i for i, (k, side) in enumerate(zip(*free, strict=True))}
    both = [k for k in range(len(lines.has_line)) if lines.has_line[k].all()]
    width = lines.degree + 1
    jacobian = np.zeros((len(both) * len(points), len(index) * width))
    for row, k in enumerate(both):
        rows = slice(row * len(points), (row + 1) * len(points))
        for side, sign in ((0, -1.0), (1, 1.0)):
            at = index[k, side] * width
            jacobian[rows, at : at + width] = sign * matrix @ scale[index[k, side]]
    at_start = lines.at(points)
    gap = (at_start.upper_m_s - at_start.lower_m_s)[both].ravel() - MINIMUM_GAP_M_S
    return {"type": "ineq", "fun": lambda y: jacobian @ y + gap, "jac": lambda y: jacobian}


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
