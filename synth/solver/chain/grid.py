"""The quantised state space: path quanta and kinetic energy."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import psutil

from plant_models import Plant
from plant_models.errors import require
from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.problem.resolution import Resolution

MARGIN_CELLS = 10
"""Cells of the energy grid above the fastest pass: interpolation there must not ripple into it."""

EVEN = 1e-9
"""Quanta whose widths differ by no more than this part are alike."""


@frozen_arrays
class Grid:
    """Nodes of the state space.

    `path_m` (N + 1,): rising, from where the regulator acts to S_exit; `path_step_m`: their mean distance ΔS;
    `energy_m2_s2` (E,): e_j = j·Δe, e_0 = 0 standing for a stall; `speed_m_s` (E,) = sqrt(2 e).
    Sweeps count path in quanta of ΔS. Where the nodes are uneven, each quantum stands for the path between its nodes.
    """

    path_m: Floats
    path_step_m: float
    energy_m2_s2: Floats
    speed_m_s: Floats

    @property
    def stretch(self) -> Floats | float:
        """Width of every quantum over ΔS, (N,); 1 where all are alike."""
        widths = np.diff(self.path_m) / self.path_step_m
        return 1.0 if np.ptp(widths) < EVEN else widths

    def counted_m(self, node: int, travel_m: Floats) -> Floats:
        """Path from a node on, as sweeps count it; a stall, −1, stays one."""
        quanta = np.interp(self.path_m[node] + travel_m, self.path_m, np.arange(len(self.path_m))) - node
        return np.where(travel_m < 0.0, travel_m, quanta * self.path_step_m)

    @property
    def energy_step_m2_s2(self) -> float:
        """Δe."""
        return float(self.energy_m2_s2[1])


def make_grid(plant: Plant, resolution: Resolution) -> Grid:
    """The grid for `plant`: it holds every speed that an unbraked pass can reach, and a margin."""
    length_m = plant.pass_m
    quanta = max(4, round(length_m / resolution.path_step_m))
    step = resolution.speed_step_m_s * resolution.reference_speed_m_s
    downhill = max(0.0, max(plant.profile.grades_permille)) * 1e-3 * plant.cut.reduced_gravity_m_s2 * length_m
    fastest = plant.start_speed_m_s(np.array(plant.entry.high_m_s), plant.resistance.mean_n_per_kn)
    top = 0.5 * max(plant.entry.high_m_s, float(fastest)) ** 2 + downhill + MARGIN_CELLS * step
    energy = step * np.arange(math.ceil(top / step) + 1, dtype=np.float64)
    path = np.linspace(plant.start_m, plant.exit_m, quanta + 1)
    return Grid(path, float(path[1] - path[0]), energy, np.sqrt(2.0 * energy))


def memory_estimate_bytes(plant: Plant, grids: Sequence[Resolution]) -> int:
    """What a solve of `plant` on the first of `grids`, and predictions on the others, hold at most, from their largest
    arrays."""
    total = 0
    for r in grids:
        quanta = max(4, round(plant.pass_m / r.path_step_m))
        points = 0.5 * plant.entry.high_m_s**2 / (r.speed_step_m_s * r.reference_speed_m_s) * 1.2
        modes, chains = 2 * plant.top_stage, 4 * plant.top_stage
        landings = quanta * chains * 7 * points * 2
        scenarios = r.friction_nodes * r.resistance_nodes if r is grids[0] else 2
        values = 3 * scenarios * quanta * modes * r.path_levels * points
        total += int(8 * (landings + values + 6 * quanta * (plant.top_stage + 1) * points))
    return total


def require_memory(label: str, plant: Plant, grids: Sequence[Resolution], workers: int) -> None:
    """Raise `PlantError` if `workers` solves at once would not fit into this machine's memory."""
    needed = workers * memory_estimate_bytes(plant, grids)
    available = available_memory_bytes()
    require(
        needed <= 0.8 * available,
        f"grid: path_step_m is {grids[0].path_step_m:g} and speed_step_m_s {grids[0].speed_step_m_s:g}; solving "
        f"{label} would take about {needed / 1e9:.1f} GB and {available / 1e9:.1f} GB are free: make a step larger",
    )


def available_memory_bytes() -> int:
    """Memory that a process can still get without swapping."""
    return int(psutil.virtual_memory().available)
