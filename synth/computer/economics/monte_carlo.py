"""Monte Carlo: draws of all inputs through the function, and what is told of the outputs."""

from __future__ import annotations

import math
import zlib
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, frozen_arrays
from synth.computer.economics.ranges import Evaluations, Model, Ranges, evaluate, points_at, uncertain
from synth.frame.interval import Interval

QUANTILES = (0.05, 0.5, 0.95)


@frozen_arrays
class Draws:
    """Inputs `points` (inputs, n) and what came of them."""

    inputs: tuple[str, ...]
    points: Floats
    found: Evaluations

    @property
    def n(self) -> int:
        """Draws."""
        return int(self.points.shape[1])

    @property
    def impossible(self) -> Interval:
        """Share of draws whose inputs are impossible, such as a hump that is overloaded."""
        return share_of(np.isnan(self.found.values[0]))


@dataclass(frozen=True)
class OutputFigures:
    """One output over the `n` possible draws. `never`: share that is infinite. `mean`: None if any is.

    `quantiles`: of `QUANTILES`, 5, 50 and 95 %; a value or an end may be infinite.
    """

    name: str
    n: int
    never: Interval
    mean: Interval | None
    quantiles: tuple[Interval, ...]


def drawn(model: Model, ranges: Ranges, draws: int = 10_000, seed: int = 18) -> Draws:
    """`draws` independent draws of all inputs, which are independent of each other.

    Draws of an input depend on its name and the seed alone: another input more leaves them as they are.
    """
    p = {
        name: np.random.default_rng((seed, zlib.crc32(name.encode()))).random(draws) for name in uncertain(ranges)
    }  # fmt: skip
    names, points = points_at(ranges, p, draws)
    return Draws(names, points, evaluate(model, names, points))


def output_figures(draws: Draws, name: str) -> OutputFigures:
    """What the draws tell of one output."""
    held = draws.found[name]
    possible = held[~np.isnan(held)]
    ordered = np.sort(possible)
    mean = None if np.isinf(possible).any() else mean_of(possible)
    return OutputFigures(
        name=name,
        n=len(possible),
        never=share_of(np.isposinf(possible)),
        mean=mean,
        quantiles=tuple(Interval(*quantile_of(ordered, p), len(possible)) for p in QUANTILES),
    )


def share_of(hits: Bools) -> Interval:
    """Share of independent hits, with the interval of Clopper and Pearson."""
    from scipy.special import betaincinv  # start-up: scipy only where it is needed

    n, k = len(hits), int(hits.sum())
    low = float(betaincinv(k, n - k + 1, 0.025)) if k > 0 else 0.0
    high = float(betaincinv(k + 1, n - k, 0.975)) if k < n else 1.0
    return Interval(k / n, low, high, n)


def mean_of(values: Floats) -> Interval:
    """Mean of independent values, with the interval of Student."""
    from scipy.special import stdtrit  # start-up: scipy only where it is needed

    n, mean = len(values), float(values.mean())
    half = float(stdtrit(n - 1, 0.975)) * float(values.std(ddof=1)) / math.sqrt(n) if n > 1 else 0.0
    return Interval(mean, mean - half, mean + half, n)


def quantile_of(ordered: Floats, p: float) -> tuple[float, float, float]:
    """The quantile p of values in order, and its 95 % interval between two of them.

    By the binomial law of how many values lie below the quantile: for any distribution, and infinite values may be
    among them. The ends are infinite where the values are too few.
    """
    from scipy.special import bdtrik  # start-up: scipy only where it is needed

    n = len(ordered)
    value = float(ordered[min(max(math.ceil(p * n) - 1, 0), n - 1)])
    # Of K ~ Bin(n, p) values below the quantile, P(K < low) and P(K >= high) are at most 2.5 %.
    low = math.ceil(float(bdtrik(0.025, n, p)) - 1e-9)
    high = math.ceil(float(bdtrik(0.975, n, p)) - 1e-9) + 1
    return (
        value,
        float(ordered[low - 1]) if low >= 1 else -math.inf,
        float(ordered[high - 1]) if high <= n else math.inf,
    )
