"""The reference problem in plain numpy and float64, outcome by outcome: the oracle, and the slowest yardstick."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.studies.reference_problem.problem import Floats, ReferenceProblem

Indices = NDArray[np.int64]


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Outcome:
    """Where one command leads in one outcome of the noise: lower grid neighbours and the share of the upper ones.

    All of shape (P, V).
    """

    chance: float
    row: Indices
    row_share: Floats
    cell: Indices
    cell_share: Floats


def outcomes(problem: ReferenceProblem, command: int) -> Iterator[Outcome]:
    """The outcomes of one command, as the definition of the problem states them; clipped in speed and in index."""
    pressure, speed = problem.pressures_kpa[:, None], problem.speeds_m_s[None, :]
    commanded = problem.commanded_kpa[command]
    time_constant_s = np.where(commanded > pressure, problem.rise_time_s, problem.fall_time_s)
    step_m = problem.path_step_m
    after = commanded + (pressure - commanded) * np.exp(-step_m / speed / time_constant_s)
    row, row_share = located(after * (problem.pressure_points - 1) / problem.highest_pressure_kpa, after.shape[0])
    brake = problem.braking_m_s2_per_kpa * np.maximum((pressure + after) / 2.0 - problem.dead_pressure_kpa, 0.0)
    points_per_m_s = (problem.speed_points - 1) / (problem.highest_speed_m_s - problem.lowest_speed_m_s)
    for friction, friction_chance in zip(*problem.friction(), strict=True):
        for drive, drive_chance in zip(*problem.drive_m_s2(), strict=True):
            squared = speed**2 + 2.0 * step_m * (drive - friction * brake)
            squared = np.clip(squared, problem.lowest_speed_m_s**2, problem.highest_speed_m_s**2)
            place = (np.sqrt(squared) - problem.lowest_speed_m_s) * points_per_m_s
            yield Outcome(friction_chance * drive_chance, row, row_share, *located(place, after.shape[1]))


def located(place: Floats, points: int) -> tuple[Indices, Floats]:
    """Lower neighbour of a place on a grid of that many points, and the share of the upper one."""
    clipped = np.clip(place, 0.0, points - 1)
    lower = np.minimum(clipped.astype(np.int64), points - 2)
    return lower, clipped - lower


def action_values(transitions: list[list[Outcome]], value: Floats) -> Floats:
    """Expected value (U, P, V) of each command, `value` (P, V) one stage later."""
    expected = np.zeros((len(transitions), *value.shape))
    for command, of_command in enumerate(transitions):
        for o in of_command:
            low = (1.0 - o.cell_share) * value[o.row, o.cell] + o.cell_share * value[o.row, o.cell + 1]
            high = (1.0 - o.cell_share) * value[o.row + 1, o.cell] + o.cell_share * value[o.row + 1, o.cell + 1]
            expected[command] += o.chance * ((1.0 - o.row_share) * low + o.row_share * high)
    return expected


def backward(problem: ReferenceProblem) -> Iterator[tuple[Floats, Floats]]:
    """For each stage, the last first: expected values of the commands (U, P, V), and their least (P, V)."""
    transitions = [list(outcomes(problem, command)) for command in range(problem.commands)]
    value = np.tile(problem.terminal_cost, (problem.pressure_points, 1))
    for _ in range(problem.stages):
        expected = action_values(transitions, value)
        value = expected.min(axis=0)
        yield expected, value


def solve_by_numpy(problem: ReferenceProblem) -> tuple[Floats, NDArray[np.uint8]]:
    """Value at entry (P, V) and best commands (stages, P, V), the smallest of equally good ones."""
    policy = np.empty((problem.stages, problem.pressure_points, problem.speed_points), dtype=np.uint8)
    values = []
    for stage, (expected, value) in zip(range(problem.stages - 1, -1, -1), backward(problem), strict=True):
        policy[stage] = expected.argmin(axis=0)
        values = [value]
    return values[0], policy


def largest_regret(problem: ReferenceProblem, best_command: NDArray[np.uint8]) -> float:
    """What the given commands (stages, P, V) lose at most in one step, at any stage and state, m²/s².

    Exact values follow the step; so it does not matter which of equally good commands is named.
    """
    worst = 0.0
    for stage, (expected, value) in zip(range(problem.stages - 1, -1, -1), backward(problem), strict=True):
        chosen = np.take_along_axis(expected, best_command[stage][None].astype(np.int64), axis=0)[0]
        worst = max(worst, float(np.max(chosen - value)))
    return worst
