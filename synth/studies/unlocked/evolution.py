"""Direct search by evolution of a normal law: CMA-ES with the usual constants.

Source: N. Hansen, The CMA Evolution Strategy: A Tutorial, arXiv:1604.00772 (2016), figure 6; weights positive only.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


def evolve(
    cost: Callable[[Vector], float], start: Vector, spread: float, evaluations: int, seed: int
) -> tuple[Vector, float]:
    """(point of least cost met, its cost) after about `evaluations`, beginning at `start` with std `spread` each way.

    Deterministic for one `seed`; the starting point itself is evaluated first and is never lost.
    """
    n = len(start)
    rng = np.random.Generator(np.random.SFC64(seed))
    size = 4 + int(3 * math.log(n))
    parents = size // 2
    weights = math.log((size + 1) / 2) - np.log(np.arange(1, parents + 1))
    weights /= weights.sum()
    mass = 1.0 / float((weights**2).sum())
    c_sigma = (mass + 2) / (n + mass + 5)
    damping = 1 + 2 * max(0.0, math.sqrt((mass - 1) / (n + 1)) - 1) + c_sigma
    c_path = (4 + mass / n) / (n + 4 + 2 * mass / n)
    c_one = 2 / ((n + 1.3) ** 2 + mass)
    c_many = min(1 - c_one, 2 * (mass - 2 + 1 / mass) / ((n + 2) ** 2 + mass))
    usual = math.sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n))
    mean, sigma = start.astype(np.float64), spread
    covariance, path_sigma, path = np.eye(n), np.zeros(n), np.zeros(n)
    best, least = mean.copy(), cost(mean)
    for generation in range(max(0, (evaluations - 1) // size)):
        lengths, axes = np.linalg.eigh(covariance)
        root = np.sqrt(np.maximum(lengths, 1e-20))
        steps = (rng.standard_normal((size, n)) * root) @ axes.T
        points = mean + sigma * steps
        costs = np.array([cost(point) for point in points])
        order = np.argsort(costs, kind="stable")
        if costs[order[0]] < least:
            best, least = points[order[0]].copy(), float(costs[order[0]])
        chosen = steps[order[:parents]]
        step = weights @ chosen
        mean = mean + sigma * step
        path_sigma = (1 - c_sigma) * path_sigma + math.sqrt(c_sigma * (2 - c_sigma) * mass) * (
            axes @ ((axes.T @ step) / root)
        )
        length = float(np.linalg.norm(path_sigma))
        fresh = 1 - (1 - c_sigma) ** (2 * (generation + 1))
        moving = length / math.sqrt(fresh) < (1.4 + 2 / (n + 1)) * usual
        path = (1 - c_path) * path + (math.sqrt(c_path * (2 - c_path) * mass) * step if moving else 0.0)
        lost = 0.0 if moving else c_path * (2 - c_path)
        covariance = (
            (1 - c_one - c_many + c_one * lost) * covariance
            + c_one * np.outer(path, path)
            + c_many * (chosen.T * weights) @ chosen
        )
        covariance = 0.5 * (covariance + covariance.T)
        sigma *= math.exp((c_sigma / damping) * (length / usual - 1))
    final = cost(mean)  # the mean of a search under noise is often better than any point it met
    return (mean, final) if final < least else (best, least)
