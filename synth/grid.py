"""The quantised state space: path quanta, kinetic energy, and the sub-steps of a transient."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.errors import require, require_between
from synth.problem import Plant


@dataclass(frozen=True)
class Resolution:
    """How fine the state space is cut.

    `path_step_m`: ΔS, rounded so that whole quanta fill S_exit; `speed_step_m_s`: ΔV at the speed
    `reference_speed_m_s` (the grid is uniform in e = v²/2, so ΔV(v) = Δe/v); `transient_substeps`:
    parts of a sampling period in which a transient is integrated; `friction_nodes`: scenarios of ξ_cut;
    `path_levels`: levels of the Markov chain for η; `resistance_nodes`: scenarios of w.
    """

    path_step_m: float = 0.5
    speed_step_m_s: float = 0.03
    reference_speed_m_s: float = 3.0
    transient_substeps: int = 5
    friction_nodes: int = 5
    path_levels: int = 2
    resistance_nodes: int = 1

    def __post_init__(self) -> None:
        require_between("grid: path_step_m", self.path_step_m, 0.01, 5.0)
        require_between("grid: speed_step_m_s", self.speed_step_m_s, 1e-3, 0.5)
        require_between("grid: reference_speed_m_s", self.reference_speed_m_s, 0.3, 20.0)
        for name in ("transient_substeps", "friction_nodes", "path_levels", "resistance_nodes"):
            value = getattr(self, name)
            require(1 <= value <= 64, f"grid: {name} is {value}; it must be a whole number from 1 to 64")


@dataclass(frozen=True)
class Grid:
    """Nodes of the state space.

    `path_m` (N + 1,): s_n = n·ΔS, the last one S_exit; `energy_m2_s2` (E,): e_j = j·Δe, e_0 = 0 standing for
    a stall; `speed_m_s` (E,) = sqrt(2 e).
    """

    path_m: NDArray[np.float64]
    energy_m2_s2: NDArray[np.float64]
    speed_m_s: NDArray[np.float64]

    def __post_init__(self) -> None:
        for array in (self.path_m, self.energy_m2_s2, self.speed_m_s):
            array.setflags(write=False)

    @property
    def path_step_m(self) -> float:
        """ΔS."""
        return float(self.path_m[1])

    @property
    def energy_step_m2_s2(self) -> float:
        """Δe."""
        return float(self.energy_m2_s2[1])


def make_grid(plant: Plant, resolution: Resolution) -> Grid:
    """The grid for `plant`: it holds every speed that an unbraked pass can reach, and a margin."""
    quanta = max(4, round(plant.exit_m / resolution.path_step_m))
    step = resolution.speed_step_m_s * resolution.reference_speed_m_s
    downhill = max(0.0, max(plant.profile.grades_permille)) * 1e-3 * plant.cut.reduced_gravity_m_s2 * plant.exit_m
    top = 0.5 * plant.entry.high_m_s**2 + downhill + 4 * step
    energy = step * np.arange(math.ceil(top / step) + 1, dtype=np.float64)
    return Grid(np.linspace(0.0, plant.exit_m, quanta + 1), energy, np.sqrt(2.0 * energy))
