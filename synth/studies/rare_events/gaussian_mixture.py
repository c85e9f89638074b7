"""Laws to draw pass coordinates from: normal components, their mixture, and the exact weight against the true law."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.studies.rare_events.pass_coordinates import DIMENSIONS

BROAD_STD = 2.0
"""Standard deviation of the component that reaches every corner; weights under it stay below 2⁴."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class GaussianComponent:
    """Normal law of coordinates: `mean` (4,), `factor` (4, 4) lower triangular, covariance = factor·factorᵀ."""

    mean: NDArray[np.float64]
    factor: NDArray[np.float64]

    def __post_init__(self) -> None:
        if not (np.diag(self.factor) > 0.0).all() or np.triu(self.factor, 1).any():
            raise ValueError("gaussian component: the factor must be lower triangular with a positive diagonal")

    def log_ratio(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """log(density of this law / density of the standard normal law) at `x` (n, 4)."""
        y = np.linalg.solve(self.factor, (x - self.mean).T)
        log_volume = float(np.log(np.diag(self.factor)).sum())
        return np.asarray(0.5 * (x**2).sum(axis=1) - 0.5 * (y**2).sum(axis=0) - log_volume, dtype=np.float64)


NOMINAL = GaussianComponent(np.zeros(DIMENSIONS), np.eye(DIMENSIONS))
"""The true law."""

BROAD = GaussianComponent(np.zeros(DIMENSIONS), BROAD_STD * np.eye(DIMENSIONS))


@dataclass(frozen=True)
class GaussianMixture:
    """Components and the shares (sum 1) of passes that each is given, in turn along the row of passes.

    The first component is the true law itself (defensive mixture, Hesterberg 1995), so no weight exceeds
    1 / `shares`[0].
    """

    components: tuple[GaussianComponent, ...]
    shares: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.components) != len(self.shares) or abs(math.fsum(self.shares) - 1.0) > 1e-9:
            raise ValueError("gaussian mixture: as many shares as components are needed, and they must sum to 1")
        if self.components[0] is not NOMINAL or min(self.shares) <= 0.0:
            raise ValueError("gaussian mixture: the first component must be the true law, and every share positive")

    def ends(self, count: int) -> NDArray[np.int64]:
        """Of `count` passes, component k draws those from ends[k − 1] to ends[k] − 1."""
        ends = np.asarray(np.rint(np.cumsum(self.shares) * count), dtype=np.int64)
        if (np.diff(ends, prepend=0) < 2).any():
            raise ValueError(f"gaussian mixture: {count} passes leave a component fewer than 2; draw more")
        return ends

    def placed(self, standard: NDArray[np.float64], first: int, count: int) -> NDArray[np.float64]:
        """Coordinates (n, 4) of passes `first` … of `count`, made of `standard` normal ones of the same shape."""
        which = np.searchsorted(self.ends(count), np.arange(first, first + len(standard)), side="right")
        placed = np.empty_like(standard)
        for k, component in enumerate(self.components):
            mine = which == k
            placed[mine] = component.mean + standard[mine] @ component.factor.T
        return placed

    def weights(self, x: NDArray[np.float64], count: int) -> NDArray[np.float64]:
        """True density / mixture density at `x` (n, 4), the mixture as `count` passes were really shared out.

        The balance heuristic (Veach & Guibas 1995): with it the mean of weight·f over all passes is unbiased for
        any f, although every component has a fixed number of passes.
        """
        used = np.diff(self.ends(count), prepend=0) / count
        logs = np.stack([component.log_ratio(x) for component in self.components])
        largest = logs.max(axis=0)
        ratio = np.exp(largest) * (used[:, None] * np.exp(logs - largest)).sum(axis=0)
        return np.asarray(1.0 / ratio, dtype=np.float64)
