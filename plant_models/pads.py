"""The brake pads: they touch the wheels at a pressure P0, so the drive has a dead zone below it (zhukovitsky-2012).

What force follows from the pressure above that, by the number N of braked wheel pairs, is `retarder.ForceLaw`; what
deceleration, `motion.path_coefficients`; how the slope varies by chance, `friction.Friction`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def overpressure_kpa(pressure_kpa: NDArray[np.float64] | float, touch_kpa: float) -> NDArray[np.float64]:
    """p = max(0, P − P0), kPa, of the same shape."""
    return np.maximum(0.0, np.asarray(pressure_kpa, dtype=np.float64) - touch_kpa)
