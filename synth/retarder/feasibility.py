"""What a position can do for one target, whatever table it is given; plain values, no kernel behind them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Feasibility:
    """From which entry speeds the position can keep `limit_m_s`, the rms that is accepted.

    `entry_m_s` (n,) up to the position's highest entry speed, and `entry_rms_m_s` (n,): rms of the unavoidable error of
    cuts that enter with that speed; `served_m_s`: (low, high) where it meets the limit, None if nowhere.
    """

    limit_m_s: float
    entry_m_s: NDArray[np.float64]
    entry_rms_m_s: NDArray[np.float64]
    served_m_s: tuple[float, float] | None
