"""Switching surfaces V_lo,k(S, P) and V_hi,k(S, P) over path and actual pressure, on the nodes of a grid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.solver.any_time.drive_modes import DriveModes


@frozen_arrays
@dataclass(frozen=True, eq=False)
class SwitchingSurfaces:
    """Below `lower_m_s` go a stage down, above `upper_m_s` go a stage up, between them hold; at every sample.

    `nodes_m` (N + 1,) equally spaced, the last one S_exit; `lower_m_s`, `upper_m_s` (M, N + 1), one pair of lines for
    each mode of `modes`, linear in path and, between modes of one stage and one wait, in pressure; ∓inf: no command.
    """

    modes: DriveModes
    nodes_m: NDArray[np.float64]
    lower_m_s: NDArray[np.float64]
    upper_m_s: NDArray[np.float64]

    def __post_init__(self) -> None:
        shape = (len(self.modes.stage), len(self.nodes_m))
        if self.lower_m_s.shape != shape or self.upper_m_s.shape != shape:
            raise ValueError(f"switching surfaces: shape {self.lower_m_s.shape} does not fit {shape} modes and nodes")

    def of_stage(self, stage: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """(pressures (·,), their modes (·,)) of one commanded stage, by rising pressure.

        Of the modes at one pressure, the one that waits least: where the valve is open, or the stage at rest.
        """
        m = self.modes
        chosen = np.flatnonzero(m.stage == stage)
        chosen = chosen[np.lexsort((m.waits_s[m.wait[chosen]], m.node[chosen]))]
        _, first = np.unique(m.node[chosen], return_index=True)
        return m.pressure_kpa[chosen[first]], chosen[first]


def surfaces_at(modes: DriveModes, nodes_m: NDArray[np.float64], lines_m_s: NDArray[np.float64]) -> SwitchingSurfaces:
    """Surfaces of the lines (2, N, M) at the starts of the quanta between `nodes_m` (N + 1,); the last one holds on."""
    lower, upper = (np.concatenate([each, each[-1:]]).T.copy() for each in lines_m_s)
    return SwitchingSurfaces(modes, np.array(nodes_m), lower, upper)
