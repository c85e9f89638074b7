"""The reference problem by QuantEcon's `DiscreteDP`, if it is installed: backward induction over sparse matrices."""

from __future__ import annotations

import importlib

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import vstack

from synth.studies.reference_problem.by_scipy import command_matrix
from synth.studies.reference_problem.problem import Floats, ReferenceProblem


def quantecon_is_there() -> bool:
    """Whether QuantEcon can be imported; it is in no requirement of this package."""
    try:
        importlib.import_module("quantecon.markov")
    except ImportError:
        return False
    return True


def solve_by_quantecon(problem: ReferenceProblem) -> tuple[Floats, NDArray[np.uint8]]:
    """Value at entry (P, V) and best commands (stages, P, V). QuantEcon maximises, so costs change their sign.

    The state-action form, states slowest as QuantEcon wants them; no discount, no reward but the terminal one.
    """
    markov = importlib.import_module("quantecon.markov")
    shape = (problem.pressure_points, problem.speed_points)
    states, commands = shape[0] * shape[1], problem.commands
    by_command = vstack([command_matrix(problem, command) for command in range(commands)], format="csr")
    order = np.arange(states * commands).reshape(commands, states).T.ravel()
    state, action = np.repeat(np.arange(states), commands), np.tile(np.arange(commands), states)
    process = markov.DiscreteDP(np.zeros(states * commands), by_command[order], 1.0 - 1e-16, state, action)
    values, policies = markov.backward_induction(
        process, problem.stages, -np.tile(problem.terminal_cost, problem.pressure_points)
    )
    return -values[0].reshape(shape), policies.astype(np.uint8).reshape(problem.stages, *shape)
