"""Every way to solve the reference problem by its name; importing this file imports none of them."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from synth.studies.reference_problem.problem import ReferenceProblem

    Solved = tuple[NDArray[np.floating], NDArray[np.uint8]]
    Solve = Callable[[ReferenceProblem], Solved]

SCIPY, QUANTECON, PLAIN_LOOPS, NUMPY = "scipy CSR", "QuantEcon DiscreteDP", "numba, plain loops", "numpy"
SLOW = (PLAIN_LOOPS, NUMPY)

_PEERS = {
    SCIPY: ("by_scipy", "solve_by_scipy"),
    QUANTECON: ("by_quantecon", "solve_by_quantecon"),
    PLAIN_LOOPS: ("by_plain_loops", "solve_by_plain_loops"),
    NUMPY: ("by_numpy", "solve_by_numpy"),
}


def kernels(threads: int) -> str:
    """The name of the kernels on so many threads."""
    return f"kernels, {threads} thread{'s' if threads > 1 else ''}"


def peers() -> tuple[str, ...]:
    """All others that can be imported here."""
    from synth.studies.reference_problem.by_quantecon import quantecon_is_there

    return tuple(name for name in _PEERS if name != QUANTECON or quantecon_is_there())


def solver_named(name: str, threads: int) -> Solve:
    """Value at entry and best commands by the way called `name`; the kernels keep threads and memory between calls."""
    if name in _PEERS:
        module, function = _PEERS[name]
        found: Solve = getattr(import_module(f"synth.studies.reference_problem.{module}"), function)
        return found
    from synth.studies.reference_problem.solver import ReferenceSolver

    solver = ReferenceSolver(threads)

    def solve(problem: ReferenceProblem) -> Solved:
        solution = solver.solve(problem)
        return solution.value_at_entry, solution.best_command

    return solve
