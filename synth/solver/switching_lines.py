"""Switching lines V_lo,k(s) and V_hi,k(s) over path nodes and stages (the switching matrices of zhukovitsky-2002)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.solver.chain.decisions import Decisions


@frozen_arrays
@dataclass(frozen=True, eq=False)
class SwitchingLines:
    """Below `lower_m_s[k]` go a stage down, above `upper_m_s[k]` go a stage up, between them hold.

    `nodes_m` (N + 1,) increasing from 0 to S_exit, equally spaced; `lower_m_s` and `upper_m_s` of shape
    (K + 1, N + 1), linear between nodes; −inf / +inf where the stage has no such command.
    """

    nodes_m: NDArray[np.float64]
    lower_m_s: NDArray[np.float64]
    upper_m_s: NDArray[np.float64]

    def __post_init__(self) -> None:
        if self.lower_m_s.shape != self.upper_m_s.shape or self.lower_m_s.shape[1:] != self.nodes_m.shape:
            raise ValueError(
                f"switching lines: shapes {self.lower_m_s.shape} and {self.upper_m_s.shape} do not fit "
                f"{self.nodes_m.shape[0]} path nodes"
            )

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return int(self.lower_m_s.shape[0])

    def at_decisions(self, decisions: Decisions) -> NDArray[np.float64]:
        """The lines (2, R, K + 1), down and up; the nodes must be those of the path."""
        return np.stack([self.lower_m_s[:, decisions.node].T, self.upper_m_s[:, decisions.node].T])

    def at(self, nodes_m: NDArray[np.float64]) -> SwitchingLines:
        """The same lines at other path nodes."""
        lower, upper = (
            np.array([np.interp(nodes_m, self.nodes_m, line) for line in side])
            for side in (self.lower_m_s, self.upper_m_s)
        )
        return SwitchingLines(np.array(nodes_m), lower, upper)
