"""What controllers are compared by; plain values, no kernel behind them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from synth.simulation.exit_statistics import ExitStatistics


@dataclass(frozen=True)
class Measured:
    """One controller's closed-loop result; `predicted_rms_m_s` where a prediction exists, else NaN."""

    name: str
    statistics: ExitStatistics
    predicted_rms_m_s: float = float("nan")


@dataclass(frozen=True)
class Feasibility:
    """Entry speeds that the position can serve when the friction is known.

    `entry_m_s` (n,) from the target to the position's highest entry speed, and `bound_rms_m_s` (n,): friction-known
    rms by entry speed; `served_m_s`: (low, high) where it meets `limit_m_s`, None if nowhere; `feasible`: the
    simulated bound over the configured entry range meets the limit.
    """

    entry_m_s: NDArray[np.float64]
    bound_rms_m_s: NDArray[np.float64]
    limit_m_s: float
    served_m_s: tuple[float, float] | None
    feasible: bool
