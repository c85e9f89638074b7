"""What a regulator runs at every sample: full surfaces, or polynomials of path and pressure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from synth.kernels.any_time.closed_loop import SurfaceLaw
from synth.simulation.controllers import fixed
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.any_time.switching_surfaces import SwitchingSurfaces

PRESSURE_POWERS = 3
"""A polynomial may have powers 0, 1 and 2 of the pressure."""


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
            float(surfaces.nodes_m[0]),
            float(surfaces.nodes_m[-1]),
            1.0,
            fixed(lower, np.float64),
            fixed(upper, np.float64),
            fixed(m.waits_s, np.float64),
            fixed(m.grid.nodes_kpa, np.float64),
            float(surfaces.nodes_m[1] - surfaces.nodes_m[0]),
        )


@dataclass(frozen=True)
class PolynomialController:
    """A regulator that compares speed with polynomials of path and pressure; what its valves wait for is left out.

    It takes `gauge_factor` times the true pressure for the pressure.
    """

    surfaces: PolynomialSurfaces
    gauge_factor: float = 1.0

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return len(self.surfaces.has_line)

    def law(self) -> SurfaceLaw:
        """The rule as the kernel takes it."""
        surfaces = self.surfaces
        powers = surfaces.powers()
        coefficients = np.zeros((*powers.shape[:2], PRESSURE_POWERS, powers.shape[3]))
        coefficients[:, :, : powers.shape[2]] = powers
        none = fixed(np.empty((0, 0, 0, 0)), np.float64)
        return SurfaceLaw(
            fixed(coefficients, np.float64), fixed(np.array(surfaces.has_line), np.bool_), surfaces.start_m,
            surfaces.exit_m, self.gauge_factor, none, none, fixed(np.empty(0), np.float64),
            fixed(np.empty(0), np.float64), 1.0,
        )  # fmt: skip


AnyTimeController = SurfaceController | PolynomialController
