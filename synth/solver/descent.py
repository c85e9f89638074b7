"""The descent that every polish makes: a smooth cost by sequential quadratic programming, the best point kept."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Generic, TypeVar

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays

CostAndSlopes = tuple[float, Floats]
Best = TypeVar("Best", covariant=True)
Other = TypeVar("Other")


@frozen_arrays
class Descent(Generic[Best]):
    """What a descent came to: cost of its start and of the best, evaluations used, whether and why it ended well.

    `best`: a point, or the lines, surfaces or speeds there, as a polish gives them.
    """

    best: Best
    cost_before: float
    cost_after: float
    evaluations: int
    converged: bool
    status: str

    def ending(self, best: Other, cost_after: float) -> Descent[Other]:
        """The same search, told as ending at `best`."""
        return Descent(best, self.cost_before, cost_after, self.evaluations, self.converged, self.status)


def descend(
    evaluate: Callable[[Floats], CostAndSlopes],
    first: CostAndSlopes,
    constraints: Sequence[Any],
    max_iterations: int,
    tolerance: float,
    allowed: Callable[[Floats], bool] = lambda _: True,
) -> Descent[Floats]:
    """Minimise `evaluate` from 0, where it gives `first`, under `constraints` of scipy.

    It ends when a step changes the cost by less than `tolerance` of the first cost. Coordinates should be such that the
    second derivatives at the start are about those of half the square of the distance, times the first cost. Points
    that are not `allowed` are passed through, but not kept; nor are costs below 0, which only a grid that is too coarse
    can give.
    """
    from scipy.optimize import minimize  # start-up: scipy only where it is needed

    before = first[0]
    best: list[tuple[float, Floats]] = [(before, np.zeros(len(first[1])))]
    calls = 0

    def objective(y: Any) -> Any:
        nonlocal calls
        calls += 1
        cost, slopes = evaluate(y) if y.any() else first
        if 0.0 < cost < best[0][0] and allowed(y):
            best[0] = cost, np.array(y)
        return cost / before, slopes / before

    options: Any = {"maxiter": max_iterations, "ftol": tolerance}
    result = minimize(
        objective, np.zeros(len(first[1])), jac=True, method="SLSQP", constraints=constraints, options=options
    )
    cost, point = best[0]
    return Descent(point, before, cost, calls, bool(result.success), str(result.message))
