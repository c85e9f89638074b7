"""Nodes of the pressure, and interpolation between them that never crosses an edge of a dead band."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from plant_models import RetarderPosition
from plant_models.frozen_arrays import frozen_arrays

STENCIL = 4
"""Nodes that interpolate one pressure, at most."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class PressureGrid:
    """`nodes_kpa` (B,) increasing; `breaks` (·,) indices of the nodes at which the cost has a kink, both ends included.

    Between two breaks the cost is smooth in the pressure; a break is a pressure at which some stage rests, or P0.
    """

    nodes_kpa: NDArray[np.float64]
    breaks: NDArray[np.int64]

    def weights(self, pressure_kpa: float) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Nodes (≤ 4,) and Lagrange weights at `pressure_kpa`, from nodes of its own segment; one node if it is one."""
        nodes = self.nodes_kpa
        nearest = int(np.abs(nodes - pressure_kpa).argmin())
        if abs(nodes[nearest] - pressure_kpa) < 1e-6:
            return np.array([nearest]), np.ones(1)
        after = int(np.searchsorted(nodes, pressure_kpa))
        if not 0 < after < len(nodes):
            raise ValueError(f"pressure grid: {pressure_kpa} kPa is outside {nodes[0]:g} … {nodes[-1]:g}")
        segment = int(np.searchsorted(self.breaks, after)) - 1
        low, high = int(self.breaks[segment]), int(self.breaks[segment + 1])
        first = min(max(after - 2, low), max(high - STENCIL + 1, low))
        index = np.arange(first, min(first + STENCIL, high + 1))
        x = nodes[index]
        apart = (pressure_kpa - x)[None, :] / (x[:, None] - x[None, :] + np.eye(len(x)))
        np.fill_diagonal(apart, 1.0)
        return index, np.asarray(apart.prod(axis=1), dtype=np.float64)


def pressure_grid(position: RetarderPosition, top_stage: int, step_kpa: float) -> PressureGrid:
    """Nodes at most `step_kpa` apart over all pressures that commands of 0 … `top_stage` can lead to."""
    stages = np.asarray(position.stage_pressures_kpa[: top_stage + 1])
    band, touch = position.pneumatics.dead_band_kpa, position.force.touch_pressure_kpa
    low, high = stages[0] + band, stages[-1] - band
    marks = np.unique(np.round(np.concatenate([stages - band, stages + band, [touch, low, high]]), 9))
    marks = marks[(marks >= low - 1e-9) & (marks <= high + 1e-9)]
    pieces, breaks = [marks[:1]], [0]
    for a, b in pairwise(marks):
        count = math.ceil((b - a) / step_kpa - 1e-9)
        pieces.append(np.linspace(a, b, count + 1)[1:])
        breaks.append(breaks[-1] + count)
    return PressureGrid(np.concatenate(pieces), np.array(breaks))
