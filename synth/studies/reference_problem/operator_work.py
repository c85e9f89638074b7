"""How much a sweep has to load and to multiply, counted on the operator itself: what its speed is held against."""

from __future__ import annotations

from dataclasses import dataclass, replace

from synth.studies.reference_problem.kernel_inputs import kernel_sizes
from synth.studies.reference_problem.kernels.operator_build import COLUMNS, COUNT, ROWS
from synth.studies.reference_problem.problem import ReferenceProblem
from synth.studies.reference_problem.scratch import Scratch
from synth.studies.reference_problem.solver import solve_on_one_thread


@dataclass(frozen=True)
class OperatorWork:
    """Vectors of sixteen in one stage: units, weights (on cache lines), products (their windows straddle mostly)."""

    units: int
    weights: int
    products: int


def operator_work(problem: ReferenceProblem) -> OperatorWork:
    """Build the operator and count."""
    scratch, sizes = Scratch(), kernel_sizes(problem, 1)
    solve_on_one_thread(replace(problem, stages=1), scratch)
    plan = scratch.integers("plan", sizes.chunks * sizes.units * COLUMNS).reshape(-1, COLUMNS)
    used = plan[plan[:, ROWS] > 0]
    count, rows = used[:, COUNT].astype(int), used[:, ROWS]
    return OperatorWork(len(used), int(count.sum()), int((count * rows).sum()))
