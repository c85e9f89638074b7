"""Kernel of the motion of a cut: exact, as the acceleration is constant within a path cell at constant overpressure.

Positions and times of cell edges are closed forms. The only approximation of a closed loop is that a transient is
played as its exact mean overpressure over each part of a sampling period.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats
from synth.kernels.compiling import borrowing_inline, kernel

MOVING, LEFT, STALLED = 0, 1, 2

TOGETHER = 16
"""Passes of which η is followed at a time."""


class Path(NamedTuple):
    """Cells along the path: `edges_m` (C + 1,); all others (C,) but the last two.

    `eta_std` of η in the cell, `eta_memory` correlation with the cell before (0 in the first that brakes) and
    `eta_fresh` = sqrt(1 − memory²); `drag_m_s2_per_n_kn`: deceleration by one N/kN of resistance; `approach_cells`:
    how many lie before the entrance.
    """

    edges_m: Floats
    gravity_m_s2: Floats
    brake_m_s2_per_kpa: Floats
    eta_std: Floats
    eta_memory: Floats
    eta_fresh: Floats
    drag_m_s2_per_n_kn: float
    approach_cells: int


class Cells(NamedTuple):
    """The path as one cut meets it: `edges_m` (C + 1,); acceleration without brake, `free`, and deceleration by one
    kPa, `brake`, in each cell (C,)."""

    edges_m: Floats
    free: Floats
    brake: Floats


@borrowing_inline
def advance(
    edges_m: Floats, free: Floats, brake: Floats, overpressure: float, duration_s: float, cell: int, s: float, v: float
) -> Any:
    """Move for `duration_s` under constant overpressure; returns (cell, s, v, time used, status).

    `free` and `brake` (C,) are acceleration without brake and deceleration by one kPa in each cell. Ends
    early at the exit (LEFT) or where the speed reaches 0 (STALLED).
    """
    left = duration_s
    while True:
        a = free[cell] - brake[cell] * overpressure
        gap = edges_m[cell + 1] - s
        v_end = v + a * left
        x = 0.5 * (v + v_end) * left
        if v_end > 0.0 and x < gap:
            return cell, s + x, v_end, duration_s, MOVING
        square = v * v + 2.0 * a * gap
        if square <= 0.0:
            return cell, s - 0.5 * v * v / a, 0.0, duration_s - left - v / a, STALLED
        v_edge = math.sqrt(square)
        left = max(0.0, left - 2.0 * gap / (v + v_edge))
        v = v_edge
        cell += 1
        s = edges_m[cell]
        if cell == free.shape[0]:
            return cell, s, v, duration_s - left, LEFT


@kernel
def brake_rows(path: Path, cut_factor: Floats, path_z: NDArray[np.float32], rows: Floats) -> None:
    """Deceleration by one kPa in every cell of every pass, `rows` (n, C): β·ξ_cut·(1 + η), η from cell to cell.

    Before the entrance nothing brakes and no number is used up: the same cut meets the same η with any approach.
    """
    # Several passes at once: a pass alone would wait for each cell's η before the next.
    x, cells, before = np.empty(TOGETHER), rows.shape[1], path.approach_cells
    rows[:, :before] = 0.0
    for first in range(0, rows.shape[0], TOGETHER):
        x[:] = 0.0
        passes = min(TOGETHER, rows.shape[0] - first)
        for j in range(before, cells):
            memory, fresh, std, brake = (
                path.eta_memory[j],
                path.eta_fresh[j],
                path.eta_std[j],
                path.brake_m_s2_per_kpa[j],
            )
            for k in range(passes):
                x[k] = memory * x[k] + fresh * path_z[first + k, j - before]
                factor = cut_factor[first + k] * max(0.0, 1.0 + std * x[k])  # bars do not push
                rows[first + k, j] = brake * factor
