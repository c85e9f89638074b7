"""Polynomial lines fitted to the solver's matrices by what being off the line costs."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.solver.backward_induction import Solution
from synth.solver.one_blas_thread import one_blas_thread
from synth.solver.polynomial_lines import PolynomialLines, basis, opened


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
