"""What the kernels need of a reference problem: computed in float64, rounded to float32 once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from synth.studies.reference_problem.kernels.operator_build import Physics, Sizes
from synth.studies.reference_problem.kernels.operator_sweep import MARGIN
from synth.studies.reference_problem.kernels.vectors import LANES
from synth.studies.reference_problem.problem import ReferenceProblem

PRESSURES_PER_CHUNK = 11


def kernel_sizes(problem: ReferenceProblem, targets: int) -> Sizes:
    """Sizes of the arrays for so many targets over the same dynamics."""
    width = LANES * -(-problem.speed_points // LANES)
    group = min(PRESSURES_PER_CHUNK, problem.pressure_points)
    return Sizes(
        stages=problem.stages,
        targets=targets,
        pressures=problem.pressure_points,
        speeds=problem.speed_points,
        commands=problem.commands,
        frictions=problem.friction_nodes,
        drives=problem.resistance_nodes,
        group=group,
        units=group * problem.commands,
        width=width,
        stride=width + MARGIN,
    )


def kernel_physics(problem: ReferenceProblem) -> Physics:
    """Everything but the terminal cost: equal for problems of equal `dynamics`."""
    row_kpa = problem.highest_pressure_kpa / (problem.pressure_points - 1)
    points_per_m_s = (problem.speed_points - 1) / (problem.highest_speed_m_s - problem.lowest_speed_m_s)
    speed = np.full(LANES * -(-problem.speed_points // LANES), problem.highest_speed_m_s)
    speed[: problem.speed_points] = problem.speeds_m_s
    duration_s = problem.path_step_m / speed
    friction, friction_chance = problem.friction()
    drive, drive_chance = problem.drive_m_s2()
    twice_step = 2.0 * problem.path_step_m
    braking = twice_step * problem.braking_m_s2_per_kpa
    scales = (
        braking * row_kpa / 2.0, braking * problem.dead_pressure_kpa, problem.lowest_speed_m_s**2, points_per_m_s,
    )  # fmt: skip
    return Physics(
        speed=_singles(speed),
        retention=_singles(np.exp(-duration_s / np.array([[problem.rise_time_s], [problem.fall_time_s]]))),
        commands=_singles(problem.commanded_kpa / row_kpa),
        friction=_singles(friction),
        drive=_singles(twice_step * drive),
        chance=_chances(np.outer(friction_chance, drive_chance).ravel()),
        scales=_singles(np.array(scales)),
    )


def _chances(chance: NDArray[np.float64]) -> NDArray[np.float32]:
    """Rounded so that they still add up to one: a sum of 1 + 1e-7 would multiply the value at every stage.

    What rounding took or gave goes to the least likely outcome, which has the finest steps.
    """
    rounded = _singles(chance)
    rounded[np.argmin(rounded)] += np.float32(1.0 - rounded.sum(dtype=np.float64))
    return rounded


def _singles(numbers: NDArray[np.float64]) -> NDArray[np.float32]:
    return numbers.astype(np.float32)
