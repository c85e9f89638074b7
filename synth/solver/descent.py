"""The descent that every polish makes: a smooth cost by sequential quadratic programming, the best point kept.

With it how a grid shows that is too coarse for it, and linear algebra on one thread, wherever bytes depend on it: BLAS
cuts its work into as many parts as it has threads, so the last bit of a minimum found with it would depend on the
machine and on OPENBLAS_NUM_THREADS. Our matrices are small and our threads many: more would only be in the way.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import Any, Final, Generic, TypeVar

import numpy as np
from threadpoolctl import threadpool_limits

from plant_models import PlantError
from plant_models.frozen_arrays import Floats, frozen_arrays

# How many threads BLAS has is known once in a process, whoever asks: so is who needs it to be one.
_changing = threading.Lock()
_limits = ExitStack()
_holders = 0


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Within, in all threads of this process, BLAS uses one thread; may be nested, and is a decorator too.

    Who leaves last restores what was. It cannot where other threads hold it longer than the thread that entered first,
    as only that one may change the number; one thread it remains then.
    """
    import scipy.linalg  # noqa: F401  # brings a BLAS of its own, which can be limited only once it is there

    global _holders
    with _changing:
        if _holders == 0:
            _limits.enter_context(threadpool_limits(1, user_api="blas"))
        _holders += 1
    try:
        yield
    finally:
        with _changing:
            _holders -= 1
            if _holders == 0:
                _limits.close()


class CoarseGridError(PlantError):
    """Nothing can be polished on this grid. The message tells what shows it, and what to change; `keys`: of a
    configuration, whose values the message is about."""

    def __init__(self, sentence: str, keys: tuple[str, ...] = ()) -> None:
        super().__init__(sentence)
        self.keys = keys


FINER_SPEED: Final = (
    "make grid.speed_step_m_s smaller, to a half or a quarter; a smaller grid.path_step_m alone can make it worse"
)
STEPS: Final = ("grid.speed_step_m_s", "grid.path_step_m")

OWN_GRID: Final = (
    "the grid for commands at any time follows from the sensor and the target and not from [grid]: leave this target "
    'out, or set regulator.commands to "at_rest"'
)


def require_positive(cost_m2_s2: float, start: str, remedy: str = FINER_SPEED, keys: tuple[str, ...] = STEPS) -> float:
    """The expected cost of what a polish starts from; `CoarseGridError` if it is not positive. `start`: a plural noun.

    The cost is a mean of squares, but values between the nodes of the speed grid are taken by cubic interpolation,
    whose weights are negative in part. Where the speeds of the cuts are spread over few cells, the sum can come out
    negative. Finer cells of speed end that. Finer quanta of path alone need not: each is one interpolation more.
    """
    if not cost_m2_s2 > 0.0:
        sentence = f"the grid is too coarse for these {start} (an expected square came out negative): {remedy}"
        raise CoarseGridError(sentence, keys)
    return cost_m2_s2


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
