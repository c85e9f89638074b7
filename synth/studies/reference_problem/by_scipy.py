"""The reference problem by one sparse matrix a command: what a careful user writes in scipy, and the speed to beat."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from synth.studies.reference_problem.by_numpy import outcomes
from synth.studies.reference_problem.problem import Floats, ReferenceProblem


def command_matrix(problem: ReferenceProblem, command: int) -> csr_matrix:
    """Transition probabilities (P·V, P·V) under one command; equal entries are summed up."""
    shape = (problem.pressure_points, problem.speed_points)
    column, weight = [], []
    for o in outcomes(problem, command):
        for row, row_share in ((o.row, 1.0 - o.row_share), (o.row + 1, o.row_share)):
            for cell, cell_share in ((o.cell, 1.0 - o.cell_share), (o.cell + 1, o.cell_share)):
                column.append((row * shape[1] + cell).ravel())
                weight.append((o.chance * row_share * cell_share).ravel())
    states, entries = shape[0] * shape[1], len(column)
    ends = np.arange(states + 1) * entries
    columns, weights = np.stack(column, axis=1).ravel(), np.stack(weight, axis=1).ravel()
    matrix = csr_matrix((weights, columns, ends), shape=(states, states))
    matrix.sum_duplicates()
    return matrix


def solve_by_scipy(problem: ReferenceProblem) -> tuple[Floats, NDArray[np.uint8]]:
    """Value at entry (P, V) and best commands (stages, P, V)."""
    return solve_targets_by_scipy([problem])[0]


def solve_targets_by_scipy(problems: Sequence[ReferenceProblem]) -> list[tuple[Floats, NDArray[np.uint8]]]:
    """Problems of equal dynamics over the same matrices, as many columns of values."""
    problem, count = problems[0], len(problems)
    matrices = [command_matrix(problem, command) for command in range(problem.commands)]
    shape = (problem.pressure_points, problem.speed_points)
    value = np.stack([np.tile(p.terminal_cost, problem.pressure_points) for p in problems], axis=1)
    value = value[:, 0] if count == 1 else value  # scipy's product with one vector is faster than with one column
    policy = np.empty((problem.stages, shape[0] * shape[1], count), dtype=np.uint8)
    for stage in range(problem.stages - 1, -1, -1):
        expected = np.stack([matrix @ value for matrix in matrices])
        policy[stage] = expected.argmin(axis=0).reshape(-1, count)
        value = expected.min(axis=0)
    value = value.reshape(*shape, count)
    return [(value[..., t], policy[..., t].reshape(problem.stages, *shape)) for t in range(count)]
