"""The polish: the exactly evaluated cost of the polynomial policy itself, minimised over all coefficients at once.

Its gradient comes from one forward and one backward pass (`evaluation.Evaluation.gradient`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from plant_models.frozen_arrays import Floats, Ints
from synth.solver.coarse_grid import require_positive
from synth.solver.descent import CostAndSlopes, Descent, descend
from synth.solver.one_blas_thread import one_blas_thread
from synth.solver.polynomial_lines import MINIMUM_GAP_M_S, PolynomialLines, gap_of, opened
from synth.solver.switching_lines import SwitchingLines

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
