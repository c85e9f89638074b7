"""Solves reference problems by the kernels of the short-row operator: one on all threads, or many, one a thread."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass
from queue import SimpleQueue
from types import TracebackType

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.studies.reference_problem.kernel_inputs import kernel_physics, kernel_sizes
from synth.studies.reference_problem.kernels.operator_build import COLUMNS, Sizes, reserve
from synth.studies.reference_problem.kernels.operator_sweep import MARGIN, OVERHANG, solve_share
from synth.studies.reference_problem.kernels.vectors import LANES
from synth.studies.reference_problem.problem import ReferenceProblem
from synth.studies.reference_problem.scratch import Scratch

COUNTERS_PER_LINE = 8


@frozen_arrays
@dataclass(frozen=True, eq=False)
class ReferenceSolution:
    """Value at entry (P, V) float32, m²/s², and the best command (stages, P, V) uint8, entry first; read-only."""

    value_at_entry: NDArray[np.float32]
    best_command: NDArray[np.uint8]


class ReferenceSolver:
    """Threads and their memory, kept from solve to solve; a context manager. Not for several callers at once.

    The solutions are the same, bit for bit, for any number of threads, alone or in a batch.
    """

    def __init__(self, threads: int) -> None:
        if threads < 1:
            raise ValueError("a solver needs at least one thread")
        self._threads = threads
        self._pool = ThreadPoolExecutor(max_workers=threads)
        self._scratches: SimpleQueue[Scratch] = SimpleQueue()
        for _ in range(threads):
            self._scratches.put(Scratch())

    def __enter__(self) -> ReferenceSolver:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._pool.shutdown()

    def solve(self, problem: ReferenceProblem) -> ReferenceSolution:
        """One problem on all threads."""
        return self._solve_together([problem], self._threads)[0]

    def solve_batch(self, problems: Sequence[ReferenceProblem]) -> list[ReferenceSolution]:
        """Many problems, in their order. Those of equal dynamics share one operator and one thread."""
        kinds: dict[ReferenceProblem, list[int]] = {}
        for index, problem in enumerate(problems):
            kinds.setdefault(problem.dynamics, []).append(index)
        groups = [[problems[index] for index in indices] for indices in kinds.values()]
        if len(groups) == 1:
            return self._solve_together(groups[0], self._threads)
        found: dict[int, ReferenceSolution] = {}
        for indices, solutions in zip(
            kinds.values(), self._pool.map(lambda group: self._solve_together(group, 1), groups), strict=True
        ):
            found.update(zip(indices, solutions, strict=True))
        return [found[index] for index in range(len(problems))]

    def _solve_together(self, problems: Sequence[ReferenceProblem], threads: int) -> list[ReferenceSolution]:
        """Problems of equal dynamics over one operator, on `threads` threads of which one is the caller's."""
        scratch = self._scratches.get()
        try:
            return _solved(problems, threads, scratch, self._pool)
        finally:
            self._scratches.put(scratch)


def solve_on_one_thread(problem: ReferenceProblem, scratch: Scratch) -> ReferenceSolution:
    """One problem on the caller's thread; the operator stays in the scratch memory."""
    return _solved([problem], 1, scratch, None)[0]


def _solved(
    problems: Sequence[ReferenceProblem], threads: int, scratch: Scratch, pool: Executor | None
) -> list[ReferenceSolution]:
    problem = problems[0]
    physics, sizes = kernel_physics(problem), kernel_sizes(problem, len(problems))
    units, phases = sizes.chunks * sizes.units, problem.stages + 1
    begin = np.empty(sizes.chunks + 1, dtype=np.int64)
    reserve(physics, sizes, begin)
    value = scratch.singles("value", 2, sizes.targets * sizes.pressures * sizes.stride + OVERHANG)
    _set_terminal_cost(value, problems, sizes)
    policy = np.empty((sizes.targets, sizes.stages, sizes.pressures * sizes.width), dtype=np.uint8)
    counters = (
        scratch.counters("taken", phases * threads * COUNTERS_PER_LINE),
        scratch.counters("done", phases * COUNTERS_PER_LINE),
    )
    arrays = (
        begin, physics, sizes, scratch.integers("plan", units * COLUMNS),
        scratch.singles("weights", int(begin[-1]) * LANES), scratch.singles("position", units * LANES),
    )  # fmt: skip
    own = [_scratch_of_thread(thread, sizes, scratch) for thread in range(threads)]
    helpers = [
        pool.submit(solve_share, thread, threads, *counters, *arrays, own[thread], value, policy)
        for thread in range(1, threads)
        if pool is not None
    ]
    try:
        solve_share(0, threads, *counters, *arrays, own[0], value, policy)
    finally:
        # A helper that has not begun is not needed any more; one that has must end before the memory is used again.
        for helper in helpers:
            if not helper.cancel():
                helper.result()
    return _solutions(value[problem.stages % 2], policy, sizes)


def _scratch_of_thread(
    thread: int, sizes: Sizes, scratch: Scratch
) -> tuple[NDArray[np.float32], NDArray[np.int64], NDArray[np.float32]]:
    return (
        scratch.singles(f"landing {thread}", sizes.frictions * sizes.drives * LANES),
        scratch.counters(f"keys {thread}", sizes.units),
        scratch.singles(f"expected {thread}", 2 * sizes.units * LANES),
    )


def _set_terminal_cost(value: NDArray[np.float32], problems: Sequence[ReferenceProblem], sizes: Sizes) -> None:
    """Terminal cost into the first of two value arrays; windows reach into the margins, which must be finite."""
    value[:] = 0.0
    for grid, problem in zip(_grids(value[0], sizes), problems, strict=True):
        grid[:] = problem.terminal_cost


def _grids(value: NDArray[np.float32], sizes: Sizes) -> NDArray[np.float32]:
    """The values (targets, P, V) in the flat array of the kernels."""
    shape = (sizes.targets, sizes.pressures, sizes.stride)
    return value[: int(np.prod(shape))].reshape(shape)[:, :, MARGIN : MARGIN + sizes.speeds]


def _solutions(value: NDArray[np.float32], policy: NDArray[np.uint8], sizes: Sizes) -> list[ReferenceSolution]:
    at_entry = _grids(value, sizes).copy()
    commands = policy.reshape(sizes.targets, sizes.stages, sizes.pressures, sizes.width)[..., : sizes.speeds]
    at_entry.flags.writeable = commands.flags.writeable = False
    return [ReferenceSolution(at_entry[target], commands[target]) for target in range(sizes.targets)]
