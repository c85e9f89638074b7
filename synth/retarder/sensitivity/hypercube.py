"""Points that fill the unit cube evenly in every direction (McKay, Beckman and Conover 1979)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def unit_hypercube(parameters: int, points: int, seed: int) -> NDArray[np.float64]:
    """Points of a Latin hypercube, (points, parameters), each number in [0, 1)."""
    from scipy.stats import qmc  # start-up: scipy only where it is needed

    unit: NDArray[np.float64] = qmc.LatinHypercube(parameters, rng=np.random.default_rng(seed)).random(points)
    return unit
