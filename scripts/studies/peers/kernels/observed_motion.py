"""What the peers take from the tables' estimator: the one place that knows how its state is laid out."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from synth.kernels.compiling import part
from synth.kernels.loop.regulator import estimated_speed
from tuning_tables.programs.held import ESTIMATE, FACTOR, LineTable

KNOWN = len(ESTIMATE.members)
"""Numbers of the state."""


@part
def observed(table: LineTable, state: NDArray[np.float32], s: float, measured: float, overpressure_kpa: float) -> Any:
    """(estimated speed, m/s, estimated friction factor) after one more sample; speed −1 before the first reading."""
    speed = float(estimated_speed(table, state, s, measured, overpressure_kpa))
    return speed, float(state[FACTOR])
