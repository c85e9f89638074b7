"""Switching lines V_lo,k(s) and V_hi,k(s) over path nodes and stages (the switching matrices of zhukovitsky-2002)."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.solver.chain.decisions import Decisions


@frozen_arrays
class SwitchingLines:
    """Below `lower_m_s[k]` go down, above `upper_m_s[k]` go up, between them hold.

    A command goes on, as far as it may, to the stage at which the same speed no longer asks for the next.

    `nodes_m` (N + 1,) increasing from 0 to S_exit, equally spaced; `lower_m_s` and `upper_m_s` of shape
    (K + 1, N + 1), linear between nodes; −inf / +inf where the stage has no such command.
    """

    nodes_m: Floats
    lower_m_s: Floats
    upper_m_s: Floats

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

    def at_decisions(self, decisions: Decisions) -> Floats:
        """The lines (C, R, K + 1); the nodes must be those of the path.

        By d stages or more a command goes where the speed is beyond the lines of d stages on end: below the lowest of
        the lower ones, above the highest of the upper ones.
        """
        lower, upper = self.lower_m_s[:, decisions.node], self.upper_m_s[:, decisions.node]
        found = np.empty((decisions.commands, *lower.T.shape))
        for d, (down, up) in enumerate(zip(found[0::2], found[1::2], strict=True), start=1):
            down[:], up[:] = -np.inf, np.inf
            for k in range(d, self.stages):
                down[:, k] = lower[k - d + 1 : k + 1].min(axis=0)
                up[:, k - d] = upper[k - d : k].max(axis=0)
        return found

    def slopes(self, decisions: Decisions, by_command: Floats) -> Floats:
        """Derivatives by the lower and the upper lines, (I, 2, R, K + 1): of a command by the line that decides."""
        lower, upper = self.lower_m_s[:, decisions.node], self.upper_m_s[:, decisions.node]
        found = np.zeros((len(by_command), 2, *lower.T.shape))
        places = np.arange(len(decisions))
        for d in range(1, decisions.farthest + 1):
            for k in range(d, self.stages):
                first, above = k - d + 1, k - d
                down, up = lower[first : k + 1].argmin(axis=0) + first, upper[above:k].argmax(axis=0) + above
                found[:, 0, places, down] += by_command[:, 2 * d - 2, :, k]
                found[:, 1, places, up] += by_command[:, 2 * d - 1, :, above]
        return found

    def at(self, nodes_m: Floats) -> SwitchingLines:
        """The same lines at other path nodes."""
        lower, upper = (
            np.array([np.interp(nodes_m, self.nodes_m, line) for line in side])
            for side in (self.lower_m_s, self.upper_m_s)
        )
        return SwitchingLines(np.array(nodes_m), lower, upper)


def always_up(nodes_m: Floats, stages: int) -> SwitchingLines:
    """Lines of so many stages below every speed: each decision raises, as far as there is a stage and it may."""
    lower, upper = np.full((stages, len(nodes_m)), -np.inf), np.full((stages, len(nodes_m)), -1.0)
    upper[-1] = np.inf
    return SwitchingLines(nodes_m, lower, upper)
