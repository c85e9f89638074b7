"""What a position can do for one target, whatever table it is given; plain values, no kernel behind them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.simulation.unavoidable_error import UnavoidableError


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Feasibility:
    """Whether the position can keep `limit_m_s`, the rms that is accepted, and from which entry speeds.

    `unavoidable`: of the configured entry speeds. `entry_m_s` (n,) up to the position's highest entry speed, and
    `entry_rms_m_s` (n,): rms of the unavoidable error of cuts that enter with that speed; `served_m_s`: (low, high)
    where it meets the limit, None if nowhere.
    """

    limit_m_s: float
    unavoidable: UnavoidableError
    entry_m_s: NDArray[np.float64]
    entry_rms_m_s: NDArray[np.float64]
    served_m_s: tuple[float, float] | None

    @property
    def feasible(self) -> bool:
        """The position does not forbid the limit, or the passes cannot tell."""
        return not self.unavoidable.forbids(self.limit_m_s)

    @property
    def obstacle(self) -> str:
        """What stands in the way of an infeasible case, in three words."""
        return self.unavoidable.obstacle
