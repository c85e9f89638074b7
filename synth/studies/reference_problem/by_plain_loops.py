"""The reference problem by plain numba loops in float64."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from synth.studies.reference_problem.kernels.plain_sweep import locate_plainly, sweep_plainly
from synth.studies.reference_problem.problem import Floats, ReferenceProblem


def solve_by_plain_loops(problem: ReferenceProblem) -> tuple[Floats, NDArray[np.uint8]]:
    """Value at entry (P, V) and best commands (stages, P, V)."""
    (friction, friction_chance), (drive, drive_chance) = problem.friction(), problem.drive_m_s2()
    chance = np.outer(friction_chance, drive_chance).ravel()
    value = np.tile(problem.terminal_cost, (problem.pressure_points, 1))
    policy = np.empty((problem.stages, *value.shape), dtype=np.uint8)
    row_place = np.empty((*value.shape, problem.commands))
    cell_place = np.empty((*row_place.shape, chance.size))
    locate_plainly(
        problem.path_step_m, problem.pressures_kpa, problem.speeds_m_s, problem.commanded_kpa, friction, drive,
        problem.rise_time_s, problem.fall_time_s, problem.braking_m_s2_per_kpa, problem.dead_pressure_kpa, row_place,
        cell_place,
    )  # fmt: skip
    sweep_plainly(row_place, cell_place, chance, value, policy)
    return value, policy
