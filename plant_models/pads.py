"""The brake pads: they touch the wheels at a pressure P0, so the drive has a dead zone below it (zhukovitsky-2012).

What force follows from the pressure above that, by the number N of braked wheel pairs, is `retarder.ForceLaw`; what
deceleration, `motion.path_coefficients`; how the slope varies by chance, `friction.Friction`.
"""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats


def overpressure_kpa(pressure_kpa: Floats | float, touch_kpa: float) -> Floats:
    """p = max(0, P − P0), kPa, of the same shape."""
    return np.maximum(0.0, np.asarray(pressure_kpa, dtype=np.float64) - touch_kpa)
