"""The distribution of the exit speed that a policy is predicted to give."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.problem.terminal_cost import share_above


@frozen_arrays
@dataclass(frozen=True, eq=False)
class ExitDensity:
    """Distribution at the exit: `probability` (E,) at `speed_m_s` (E,), the rest as probabilities or means.

    `escaped` is mass that ran off the top of the grid somewhere; it should be zero.
    """

    speed_m_s: NDArray[np.float64]
    probability: NDArray[np.float64]
    stalled: float
    escaped: float
    switchings: float

    def rms_m_s(self, target_speed_m_s: float) -> float:
        """Root mean square exit-speed error; a stall counts as exit speed 0."""
        square = (self.probability * (self.speed_m_s - target_speed_m_s) ** 2).sum()
        return float(np.sqrt(max(square + self.stalled * target_speed_m_s**2, 0.0)))

    def bias_m_s(self, target_speed_m_s: float) -> float:
        """Mean exit-speed error; a stall counts as exit speed 0."""
        first = (self.probability * (self.speed_m_s - target_speed_m_s)).sum()
        return float(first - self.stalled * target_speed_m_s)

    def p_overspeed(self, limit_m_s: float) -> float:
        """P(exit speed > limit), the cell that holds the limit shared linearly in energy."""
        return float(max((self.probability * share_above(self.speed_m_s, limit_m_s)).sum(), 0.0))
