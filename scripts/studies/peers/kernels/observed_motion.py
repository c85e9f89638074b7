"""What the peers take from the tables' estimator: the one place that knows how its state is laid out."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from synth.kernels.loop.regulator import estimated_speed
from synth.kernels.vector.borrowing import borrowing
from tuning_tables.estimator import STATE_SIZE

FACTOR = 3
"""Place of the friction factor ξ in the state of `tuning_tables.estimator`."""

KNOWN = STATE_SIZE
"""Numbers of that state."""


@borrowing
def observed(
    parameters: NDArray[np.float32], work: NDArray[np.float32], state: NDArray[np.float32], s: float, measured: float,
    overpressure_kpa: float,
) -> Any:  # fmt: skip
    """(estimated speed, m/s, estimated friction factor) after one more sample; speed −1 before the first reading."""
    speed = float(estimated_speed(parameters, work, state, s, measured, overpressure_kpa))
    return speed, float(state[FACTOR])
