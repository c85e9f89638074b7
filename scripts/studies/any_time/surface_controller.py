"""A regulator that runs full surfaces, as no controller could hold them: what polynomials are compared with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from scripts.studies.any_time.switching_surfaces import SwitchingSurfaces
from synth.kernels.any_time.closed_loop import AnyTimeLaw, NodeSurfaces
from synth.simulation.controllers import LineController, fixed
from synth.solver.switching_lines import SwitchingLines


@dataclass(frozen=True)
class SurfaceController:
    """A regulator that knows its pressure exactly, and what its valves wait for, and compares speed with surfaces."""

    surfaces: SwitchingSurfaces

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return self.surfaces.modes.stages

    def law(self) -> AnyTimeLaw:
        """The rule as the kernel takes it."""
        m, surfaces = self.surfaces.modes, self.surfaces
        shape = (m.stages, len(m.waits_s), len(m.grid.nodes_kpa), len(surfaces.nodes_m))
        lower, upper = np.full(shape, -np.inf), np.full(shape, np.inf)
        for wait in range(len(m.waits_s)):
            here = (m.wait == wait) | m.rests  # a stage at rest waits for nothing, whatever was waited for beside it
            place = m.stage[here], np.full(int(here.sum()), wait), m.node[here]
            lower[place], upper[place] = surfaces.lower_m_s[here], surfaces.upper_m_s[here]
        nodes = NodeSurfaces(
            fixed(lower, np.float64),
            fixed(upper, np.float64),
            fixed(m.waits_s, np.float64),
            fixed(m.grid.nodes_kpa, np.float64),
            float(surfaces.nodes_m[0]),
            float(surfaces.nodes_m[1] - surfaces.nodes_m[0]),
        )
        return AnyTimeLaw(
            LineController(no_lines(m.stages)).rule,
            fixed(np.empty((0, 2)), np.float32),
            fixed(np.empty(0), np.float32),
            0,
            1.0,
            nodes,
        )


def no_lines(stages: int) -> SwitchingLines:
    """Lines that never command, for a rule that is not asked."""
    never = np.full((stages, 2), np.inf)
    return SwitchingLines(np.array([0.0, 1.0]), -never, never)
