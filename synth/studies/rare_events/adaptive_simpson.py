"""Simpson's rule for several integrands at once, refined where it is wrong."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays

Integrand = Callable[[NDArray[np.float64]], NDArray[np.float64]]
"""Points (n,) → values (n, M)."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Integral:
    """`value` (M,) and `error` (M,): the sum over panels of |one panel − its two halves|; `points` evaluated.

    The value is that of the halves, whose own error is 15 times smaller than `error` where the integrand is smooth.
    """

    value: NDArray[np.float64]
    error: NDArray[np.float64]
    points: int


def adaptive_simpson(
    integrand: Integrand, low: float, high: float, panels: int, tolerance: float, floor: float, rounds: int = 8
) -> Integral:
    """∫ from `low` to `high`, first on equal `panels`, then halving those that matter, at most `rounds` times.

    A panel is halved while the disagreement of any integrand in it exceeds its share `tolerance`·(|integral| +
    `floor`) / `panels`. All points of a round are asked for in one call.
    """
    edges = np.linspace(low, high, panels + 1)
    starts, widths = edges[:-1], np.diff(edges)
    first = integrand(np.concatenate([edges, edges[:-1] + 0.5 * widths]))
    points = len(first)
    left, right, middle = first[:panels], first[1 : panels + 1], first[panels + 1 :]
    kept_value, kept_error = np.zeros(first.shape[1]), np.zeros(first.shape[1])
    for turn in range(rounds + 1):
        quarters = integrand(np.concatenate([starts + 0.25 * widths, starts + 0.75 * widths]))
        points += len(quarters)
        one, three = quarters[: len(starts)], quarters[len(starts) :]
        whole = widths[:, None] / 6.0 * (left + 4.0 * middle + right)
        halves = widths[:, None] / 12.0 * (left + 4.0 * one + 2.0 * middle + 4.0 * three + right)
        apart = np.abs(halves - whole)
        total = np.abs(kept_value + halves.sum(axis=0)) + floor
        again = (apart > tolerance * total / panels).any(axis=1) & (turn < rounds)
        kept_value += halves[~again].sum(axis=0)
        kept_error += apart[~again].sum(axis=0)
        if not again.any():
            break
        left, one, middle, three, right = (part[again] for part in (left, one, middle, three, right))
        starts, widths = starts[again], 0.5 * widths[again]
        starts, widths = np.concatenate([starts, starts + widths]), np.concatenate([widths, widths])
        left, middle, right = (
            np.concatenate([left, middle]), np.concatenate([one, three]), np.concatenate([middle, right])
        )  # fmt: skip
    return Integral(kept_value, kept_error, points)
