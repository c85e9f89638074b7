"""The four directions in which a pass can run out of brake power, as standard normal coordinates.

By eq. (3) of docs/method.md the energy at the exit falls linearly with ξ_cut·Σ(1 + η)·β·p and with w, and rises
with that at the entry. So of the hundreds of random numbers of a pass four matter for an over-speed: ξ_cut, the
work of η over the whole position, the entry speed and w. Moving only these keeps importance weights small; the
others (sensor, sampling phase, η across the work) stay as they were drawn.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.simulation.closed_loop import ClosedLoop
from synth.simulation.random_passes import RandomPasses

DIMENSIONS = 4
"""ξ_cut, work of η, entry speed, w."""

BELOW_ONE = 1.0 - 2.0**-53
"""The largest double below 1: uniform numbers stay in [0, 1)."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class PassCoordinates:
    """Coordinates (n, 4) of passes, standard normal and independent when the passes are.

    `direction` (C,), a unit vector: the second coordinate is its product with the first C numbers of `path_z`.
    """

    direction: NDArray[np.float64]

    def __post_init__(self) -> None:
        if abs(float(self.direction @ self.direction) - 1.0) > 1e-9:
            raise ValueError("pass coordinates: the direction along the path must be a unit vector")

    def of(self, passes: RandomPasses) -> NDArray[np.float64]:
        """(n, 4) coordinates of `passes`; a uniform 0 counts as the smallest positive number."""
        from scipy.special import ndtri  # start-up: scipy only where it is needed

        work = passes.path_z[:, : len(self.direction)].astype(np.float64) @ self.direction
        tiny = np.finfo(np.float64).tiny
        entry, resistance = (ndtri(np.maximum(u, tiny)) for u in (passes.entry_u, passes.resistance_u))
        return np.stack([passes.cut_z, work, entry, resistance], axis=1)

    def moved(self, passes: RandomPasses, here: NDArray[np.float64], there: NDArray[np.float64]) -> RandomPasses:
        """`passes`, which stand at `here` = `of(passes)`, moved to the coordinates `there`; all else unchanged."""
        from scipy.special import ndtr  # start-up: scipy only where it is needed

        path = passes.path_z.copy()
        cells = len(self.direction)
        path[:, :cells] += np.outer(there[:, 1] - here[:, 1], self.direction).astype(np.float32)
        return RandomPasses(
            cut_z=there[:, 0].copy(),
            entry_u=np.minimum(ndtr(there[:, 2]), BELOW_ONE),
            phase_u=passes.phase_u,
            resistance_u=np.minimum(ndtr(there[:, 3]), BELOW_ONE),
            path_z=path,
            noise_z=passes.noise_z,
            loss_key=passes.loss_key,
            weight=passes.weight,
        )


def path_work_coordinates(loop: ClosedLoop) -> PassCoordinates:
    """Coordinates whose direction along the path is the gradient of Σ β·η·Δs, the brake work of η at one pressure.

    η is an AR(1) over the cells, η_j = std_j·x_j, x_j = memory_j·x_{j−1} + fresh_j·z_j, so the gradient by z_j
    is found by running the recursion backward (its transpose). Without path noise any direction serves.
    """
    path = loop.path
    by_level = path.brake_m_s2_per_kpa * path.eta_std * np.diff(path.edges_m)
    gradient, later = np.zeros(len(by_level)), 0.0
    for j in range(len(by_level) - 1, -1, -1):
        later = by_level[j] + (path.eta_memory[j + 1] * later if j + 1 < len(by_level) else 0.0)
        gradient[j] = path.eta_fresh[j] * later
    length = float(np.linalg.norm(gradient))
    if length == 0.0:
        gradient, length = np.ones(len(by_level)), float(len(by_level)) ** 0.5
    return PassCoordinates(gradient / length)
