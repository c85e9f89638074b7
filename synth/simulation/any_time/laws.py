"""What an unlocked regulator runs at every sample: full surfaces, or a compact polynomial of path and pressure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.simulation.controllers import fixed
from synth.solver.any_time.drive_modes import DriveModes
from synth.solver.switching_lines import SwitchingLines
from synth.studies.unlocked.kernels.unlocked_loop import SurfaceLaw
from synth.studies.unlocked.surfaces import SwitchingSurfaces

PRESSURE_POWERS = 3
"""A compact line may have powers 0, 1 and 2 of the pressure."""


@dataclass(frozen=True)
class SurfaceController:
    """A regulator that knows its pressure exactly, and what its valves wait for, and compares speed with surfaces."""

    surfaces: SwitchingSurfaces

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return self.surfaces.modes.stages

    def law(self) -> SurfaceLaw:
        """The rule as the kernel takes it."""
        m, surfaces = self.surfaces.modes, self.surfaces
        shape = (m.stages, len(m.waits_s), len(m.grid.nodes_kpa), len(surfaces.nodes_m))
        lower, upper = np.full(shape, -np.inf), np.full(shape, np.inf)
        for wait in range(len(m.waits_s)):
            here = (m.wait == wait) | m.rests  # a stage at rest waits for nothing, whatever was waited for beside it
            place = m.stage[here], np.full(int(here.sum()), wait), m.node[here]
            lower[place], upper[place] = surfaces.lower_m_s[here], surfaces.upper_m_s[here]
        return SurfaceLaw(
            fixed(np.empty((0, 2, PRESSURE_POWERS, 1)), np.float64),
            fixed(np.empty((0, 2)), np.bool_),
            float(surfaces.nodes_m[-1]),
            fixed(lower, np.float64),
            fixed(upper, np.float64),
            fixed(m.waits_s, np.float64),
            fixed(m.grid.nodes_kpa, np.float64),
            float(surfaces.nodes_m[1]),
        )


@frozen_arrays
@dataclass(frozen=True, eq=False)
class CompactController:
    """Lines V(s, P) = Σ_j ((P − P_k)/100 kPa)^j · Σ_i a_ij u^i with u = 2 s/S_exit − 1, one pair for each stage.

    `coefficients` (K + 1, 2, 3, r + 1): lower, upper; by power of the pressure, then of u. `has_line` (K + 1, 2).
    A regulator needs its pressure; what its valves wait for is left out.
    """

    exit_m: float
    coefficients: NDArray[np.float64]
    has_line: NDArray[np.bool_]

    def __post_init__(self) -> None:
        if self.coefficients.shape[:3] != (*self.has_line.shape, PRESSURE_POWERS):
            raise ValueError(f"compact lines: coefficients of shape {self.coefficients.shape} do not fit")

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return len(self.has_line)

    def law(self) -> SurfaceLaw:
        """The rule as the kernel takes it."""
        none = fixed(np.empty((0, 0, 0, 0)), np.float64)
        return SurfaceLaw(
            fixed(self.coefficients, np.float64), fixed(self.has_line, np.bool_), self.exit_m,
            none, none, fixed(np.empty(0), np.float64), fixed(np.empty(0), np.float64), 1.0,
        )  # fmt: skip


UnlockedController = SurfaceController | CompactController


def at_rest_only(lines: SwitchingLines, modes: DriveModes) -> SwitchingSurfaces:
    """Stage-locked `lines` as surfaces: no command but at rest, there that of the stage's lines."""
    rests = modes.rests[:, None]
    lower = np.where(rests, lines.lower_m_s[modes.stage], -np.inf)
    upper = np.where(rests, lines.upper_m_s[modes.stage], np.inf)
    return SwitchingSurfaces(modes, np.array(lines.nodes_m), lower, upper)
