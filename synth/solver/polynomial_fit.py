"""Polynomial switching lines: fitted to the matrices by what being off the line costs, then polished.

The polish minimises the exactly evaluated cost of the polynomial policy itself over all coefficients at once;
its gradient comes from one forward and one backward pass (`evaluation.Evaluation.gradient`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plant_models.errors import require
from plant_models.frozen_arrays import frozen_arrays
from synth.solver.backward_induction import Solution
from synth.solver.one_blas_thread import one_blas_thread
from synth.solver.switching_lines import SwitchingLines

MINIMUM_GAP_M_S = 0.04
"""Smallest distance V_hi − V_lo of a fitted pair of lines."""

LOOSE_M_S = 0.3
"""See `whitening`."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class PolynomialLines:
    """Lines as Legendre series in x = 2 s/S_exit − 1 (well conditioned; the table holds powers of s).

    `coefficients` (K + 1, 2, r + 1): lower, upper; `has_line` (K + 1, 2).
    """

    exit_m: float
    coefficients: NDArray[np.float64]
    has_line: NDArray[np.bool_]

    @property
    def degree(self) -> int:
        """r."""
        return int(self.coefficients.shape[2]) - 1

    def at(self, nodes_m: NDArray[np.float64]) -> SwitchingLines:
        """The lines at path nodes, ±inf where there is none."""
        values: NDArray[np.float64] = self.coefficients @ basis(nodes_m, self.exit_m, self.degree).T
        lower = np.where(self.has_line[:, 0, None], values[:, 0], -np.inf)
        upper = np.where(self.has_line[:, 1, None], values[:, 1], np.inf)
        return SwitchingLines(np.array(nodes_m), lower, upper)

    def powers_of_s(self) -> NDArray[np.float64]:
        """Ascending coefficients in powers of s in metres, (K + 1, 2, r + 1)."""
        series = np.polynomial.legendre.Legendre
        converted = np.zeros_like(self.coefficients)
        for index in np.ndindex(*self.has_line.shape):
            power = series(self.coefficients[index], domain=[0.0, self.exit_m]).convert(
                kind=np.polynomial.Polynomial, domain=[-1.0, 1.0]
            )
            converted[index][: len(power.coef)] = power.coef
        return converted


def basis(nodes_m: NDArray[np.float64], exit_m: float, degree: int) -> NDArray[np.float64]:
    """Legendre polynomials at the nodes, (nodes, r + 1)."""
    return np.asarray(np.polynomial.legendre.legvander(2.0 * nodes_m / exit_m - 1.0, degree), dtype=np.float64)


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Fit:
    """Fitted lines and `curvature` (K + 1, 2, N): second derivative of the cost by every line value."""

    lines: PolynomialLines
    curvature: NDArray[np.float64]


@one_blas_thread()
def fit_lines(solution: Solution, occupancy: NDArray[np.float64], degree: int) -> Fit:
    """Weighted least squares; the weight of a node is the curvature of the cost in the line's position there.

    `occupancy` (I, N, H, L, E): expected samples under the solution's own policy. Where a line is never near a
    sample it costs nothing to be off it; a thousandth of the largest weight keeps it near its matrix.
    """
    t = solution.chain
    nodes, exit_m, stages = t.grid.path_m[:-1], t.plant.exit_m, t.actuator.stages
    has_line = np.ones((stages, 2), dtype=bool)
    has_line[0, 0] = has_line[-1, 1] = False
    matrix = basis(nodes, exit_m, degree)
    coefficients = np.zeros((stages, 2, degree + 1))
    curvature = np.zeros((stages, 2, len(nodes)))
    per_stage = stage_occupancy(occupancy, t.actuator.mode_stage, stages)
    for k, side in zip(*np.nonzero(has_line), strict=True):
        line = (solution.lines.lower_m_s, solution.lines.upper_m_s)[side][k, :-1]
        gain = (solution.gain_down, solution.gain_up)[side][:, k]
        weight = off_line_cost(line, gain, per_stage[:, k], t.grid.speed_m_s)
        curvature[k, side] = weight
        known = np.isfinite(line)
        if not known.any():
            coefficients[k, side, 0] = (0.0, t.grid.speed_m_s[-1])[side]
            continue
        root = np.sqrt(weight[known] + 1e-3 * weight[known].max() + 1e-12)
        coefficients[k, side] = np.linalg.lstsq(matrix[known] * root[:, None], line[known] * root, rcond=None)[0]
    return Fit(opened(PolynomialLines(exit_m, coefficients, has_line)), curvature)


def stage_occupancy(occupancy: NDArray[np.float64], mode_stage: NDArray[np.int64], stages: int) -> NDArray[np.float64]:
    """Expected samples by node, stage and speed, (N, K + 1, E)."""
    by_mode = occupancy.sum(axis=(0, 3))
    out = np.zeros((by_mode.shape[0], stages, by_mode.shape[2]))
    for mode, stage in enumerate(mode_stage):
        out[:, stage] += by_mode[:, mode]
    return out


def off_line_cost(
    line: NDArray[np.float64],
    gain: NDArray[np.float64],
    occupancy: NDArray[np.float64],
    speed_m_s: NDArray[np.float64],
    window_m_s: float = 0.15,
) -> NDArray[np.float64]:
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


Evaluate = Callable[[SwitchingLines], tuple[float, NDArray[np.float64], NDArray[np.float64]]]
"""Lines at path nodes → (cost, its derivatives by lower (K + 1, N) and by upper (K + 1, N))."""


@dataclass(frozen=True)
class Polish:
    """Result of `polish`: the lines, cost before and after, evaluations used, whether and why the search ended well."""

    lines: PolynomialLines
    cost_before: float
    cost_after: float
    evaluations: int
    converged: bool
    status: str


@one_blas_thread()
def polish(
    start: PolynomialLines,
    curvature: NDArray[np.float64],
    nodes_m: NDArray[np.float64],
    evaluate: Evaluate,
    max_iterations: int,
    tolerance: float = 5e-3,
) -> Polish:
    """Minimise `evaluate` over all coefficients, keeping V_hi − V_lo ≥ `MINIMUM_GAP_M_S` on the path.

    It ends when a step changes the cost by less than `tolerance` of the first cost. The cost of the result is positive
    and no higher than the start's. A negative cost can only come from a grid that is too coarse.

    Raises `PlantError` if the cost to start from is not positive: the grid is too coarse.

    Sequential quadratic programming in coordinates in which the `curvature` (K + 1, 2, N) of `fit_lines` is
    the unit matrix, so that the first steps are Newton steps.
    """
    from scipy.optimize import minimize  # start-up: scipy only where it is needed

    free, width = np.nonzero(start.has_line), start.degree + 1
    matrix = basis(nodes_m, start.exit_m, start.degree)[: curvature.shape[2]]
    first = evaluate(start.at(nodes_m))
    before = first[0]
    require(
        before > 0.0,
        "the grid is too coarse for these lines (an expected square came out negative): make path_step_m and "
        "speed_step_m_s smaller",
    )
    scale = whitening(curvature[free], matrix, before)
    best: list[tuple[float, PolynomialLines]] = [(before, start)]
    calls = 0

    def unpack(y: NDArray[np.float64]) -> PolynomialLines:
        coefficients = start.coefficients.copy()
        coefficients[free] += np.einsum("lab,lb->la", scale, y.reshape(-1, width))
        return PolynomialLines(start.exit_m, coefficients, start.has_line)

    def objective(y: Any) -> Any:
        nonlocal calls
        calls += 1
        lines = unpack(y)
        cost, by_lower, by_upper = evaluate(lines.at(nodes_m)) if y.any() else first
        # Below 0 the grid is too coarse for these lines, and its error would be what is minimised.
        if 0.0 < cost < best[0][0] and gap_of(lines) >= 0.5 * MINIMUM_GAP_M_S:
            best[0] = (cost, lines)
        gradient = np.stack([by_lower @ matrix, by_upper @ matrix], axis=1)[free]
        return cost / before, np.einsum("lab,la->lb", scale, gradient).ravel() / before

    options: Any = {"maxiter": max_iterations, "ftol": tolerance}
    constraints: Any = [gap_constraint(start, free, scale)]
    y0 = np.zeros(len(free[0]) * width)
    result = minimize(objective, y0, jac=True, method="SLSQP", constraints=constraints, options=options)
    cost, found = best[0]
    lines = opened(found)
    if lines is not found:
        cost = evaluate(lines.at(nodes_m))[0]
    if not 0.0 < cost <= before:
        cost, lines = before, start
    return Polish(lines, before, cost, calls, bool(result.success), str(result.message))


def whitening(curvature: NDArray[np.float64], matrix: NDArray[np.float64], cost: float) -> NDArray[np.float64]:
    """Per line the matrix T with Tᵀ·H·T = 1, H the Hessian of cost/`cost` by the line's coefficients.

    `curvature` (lines, N), `matrix` (N, r + 1). A line that nothing depends on is held as if moving it by
    `LOOSE_M_S` everywhere doubled the cost.
    """
    loose = matrix.T @ matrix / (len(matrix) * LOOSE_M_S**2)
    hessian = np.einsum("na,ln,nb->lab", matrix, curvature / cost, matrix) + loose
    lower = np.linalg.cholesky(hessian)
    whitened: NDArray[np.float64] = np.linalg.inv(lower).transpose(0, 2, 1)
    return whitened


def gap_constraint(
    lines: PolynomialLines, free: tuple[NDArray[np.int64], ...], scale: NDArray[np.float64]
) -> dict[str, Any]:
    """Linear inequality V_hi,k(s) − V_lo,k(s) − gap ≥ 0 at points along the path, for SLSQP."""
    points = np.linspace(0.0, lines.exit_m, 13)
    matrix = basis(points, lines.exit_m, lines.degree)
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


def gap_of(lines: PolynomialLines) -> float:
    """Smallest V_hi − V_lo over stages and a fine path mesh."""
    at = lines.at(np.linspace(0.0, lines.exit_m, 201))
    return float((at.upper_m_s - at.lower_m_s).min())


def opened(lines: PolynomialLines) -> PolynomialLines:
    """The lines with every pair moved apart, symmetrically, until its gap is at least the minimum.

    The same object where nothing need be moved.
    """
    at = lines.at(np.linspace(0.0, lines.exit_m, 201))
    short = MINIMUM_GAP_M_S - (at.upper_m_s - at.lower_m_s).min(axis=1)
    if not (short > 0.0).any():
        return lines
    coefficients = lines.coefficients.copy()
    for k in np.nonzero(short > 0.0)[0]:
        coefficients[k, 0, 0] -= 0.5 * short[k]
        coefficients[k, 1, 0] += 0.5 * short[k]
    return PolynomialLines(lines.exit_m, coefficients, lines.has_line)
