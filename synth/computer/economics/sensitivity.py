"""How much of an output comes from each input: the tornado (each alone from its 5 % to its 95 % quantile, all
others at their medians) and Sobol indices (shares of the variance).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from plant_models.errors import require
from plant_models.frozen_arrays import Floats
from synth.computer.economics.ranges import Constant, Model, Range, Ranges, evaluate, points_at, uncertain

LOW, HIGH = 0.05, 0.95


@dataclass(frozen=True)
class TornadoBar:
    """One input: its quantiles, and the output at them; NaN where the inputs are impossible, infinite for never."""

    input: str
    low_input: float
    high_input: float
    at_low: float
    at_high: float

    @property
    def swing(self) -> float:
        """How far the output goes; NaN where one end is impossible, 0 where both are never."""
        return 0.0 if self.at_low == self.at_high else abs(self.at_high - self.at_low)


@dataclass(frozen=True)
class Tornado:
    """`output` at the medians of all inputs, and a bar for each input, widest first (impossible ends before all)."""

    output: str
    at_medians: float
    bars: tuple[TornadoBar, ...]


def tornado(model: Model, ranges: Ranges, output: str) -> Tornado:
    """The bars of one output; 2·(inputs with a range) + 1 calls of the function."""
    moved = uncertain(ranges)
    n = 2 * len(moved) + 1
    p = {name: np.full(n, 0.5) for name in moved}
    for place, name in enumerate(moved):
        p[name][2 * place], p[name][2 * place + 1] = LOW, HIGH
    names, points = points_at(ranges, p, n)
    values = evaluate(model, names, points)[output]
    bars = []
    for place, name in enumerate(moved):
        low, high = 2 * place, 2 * place + 1
        row = points[names.index(name)]
        bars.append(TornadoBar(name, *(float(v) for v in (row[low], row[high], values[low], values[high]))))
    bars.sort(key=lambda bar: (not math.isnan(bar.swing), -bar.swing, bar.input))
    return Tornado(output, float(values[-1]), tuple(bars))


@dataclass(frozen=True)
class SobolIndex:
    """Of one output and one input: `first`, share of the variance by this input alone; `total`, also with others.

    `first_ci95`, `total_ci95`: 95 % intervals, which may reach below 0 and above 1, as the indices themselves may.
    """

    output: str
    input: str
    first: float
    first_ci95: tuple[float, float]
    total: float
    total_ci95: tuple[float, float]


@dataclass(frozen=True)
class Quantiles:
    """A range in the form in which scipy asks a distribution."""

    held: Range

    def ppf(self, p: Floats) -> Floats:
        """Quantiles, away from 0 and 1, where a normal law has none."""
        return self.held.quantile(np.clip(p, 1e-9, 1.0 - 1e-9))


def sobol_of(
    model: Model,
    ranges: Ranges,
    outputs: tuple[str, ...],
    points: int = 1024,
    resamples: int = 1000,
    seed: int = 18,
) -> tuple[SobolIndex, ...]:
    """First-order and total indices of `outputs`, for every input that has a range, by `scipy.stats.sobol_indices`.

    `points`: base points, a power of 2; the function is called points · (inputs + 2) times on scrambled Sobol points
    (Saltelli 2010; Jansen). Intervals: 2.5 and 97.5 % quantiles of `resamples` bootstrap samples of the base points.
    As these are spread more evenly than independent ones, the intervals are too wide: with 1024 points of Ishigami's
    function they held the index in all of 150 scrambles and were 3 to 6 times as wide as 95 % needs, with 256 points
    1.2 to 2.6 times, and held it in 95 to 100 % of 300. `PlantError` where an output is not finite at some point: ask
    a rate of pay-back instead of years, or narrow the ranges.
    """
    from scipy.stats import sobol_indices  # start-up: scipy only where it is needed

    names = uncertain(ranges)
    constants = {name: each.value for name, each in ranges.items() if isinstance(each, Constant)}
    random = np.random.default_rng(seed)
    held: list[tuple[Floats, Floats, Floats]] = []

    def kept(f_A: Floats, f_B: Floats, f_AB: Floats) -> tuple[Floats, Floats]:
        held.append((f_A, f_B, f_AB))  # the bootstrap needs the values that scipy has
        return indices(f_A, f_B, f_AB)

    found = sobol_indices(
        func=lambda at: finite_values(model, names, constants, at, outputs),
        n=points,
        dists=[Quantiles(ranges[name]) for name in names],  # type: ignore[misc]  # stubs: of one number
        method=kept,
        rng=random,
    )
    low, high = bootstrap(*held[-1], resamples, random)
    first = np.reshape(found.first_order, (len(outputs), len(names)))
    all_orders = np.reshape(found.total_order, first.shape)
    return tuple(
        SobolIndex(
            output, name,
            float(first[s, d]), (float(low[0, s, d]), float(high[0, s, d])),
            float(all_orders[s, d]), (float(low[1, s, d]), float(high[1, s, d])),
        )
        for s, output in enumerate(outputs)
        for d, name in enumerate(names)
    )  # fmt: skip


def finite_values(
    model: Model, names: tuple[str, ...], constants: dict[str, float], at: Floats, outputs: tuple[str, ...]
) -> Floats:
    """The outputs (s, n) at points (inputs, n); `PlantError` unless all are finite."""
    found = evaluate(lambda inputs: model({**constants, **inputs}), names, at)
    values = np.array([found[output] for output in outputs])
    for output, row in zip(outputs, values, strict=True):
        missing = int((~np.isfinite(row)).sum())
        why = f"; {found.faults[0][0]}" if found.faults else ""
        require(
            missing == 0,
            f"{output} is not finite at {missing} of {row.size} points, so it has no variance to share out{why}",
        )
    return values


def indices(f_A: Floats, f_B: Floats, f_AB: Floats) -> tuple[Floats, Floats]:
    """First-order and total indices (outputs, inputs) from centred values (s, n), (s, n), (d, s, n).

    S = mean(f_B·(f_AB − f_A))/V (Saltelli 2010, table 2 b), T = mean((f_A − f_AB)²)/(2V) (Jansen, table 2 f), V the
    variance of both samples together. Both are 0 where V is.
    """
    variance = np.var(np.concatenate([f_A, f_B], axis=-1), axis=-1)
    inverse = np.divide(1.0, variance, out=np.zeros_like(variance), where=variance > 0.0)
    first = np.mean(f_B * (f_AB - f_A), axis=-1) * inverse
    total = 0.5 * np.mean((f_A - f_AB) ** 2, axis=-1) * inverse
    return first.T, total.T


def bootstrap(
    f_A: Floats, f_B: Floats, f_AB: Floats, resamples: int, random: np.random.Generator
) -> tuple[Floats, Floats]:
    """2.5 and 97.5 % quantiles of both indices, each (2, outputs, inputs). scipy's own bootstrap takes no seed."""
    n = f_A.shape[-1]
    made = []
    for _ in range(resamples):
        rows = random.integers(n, size=n)
        made.append(indices(f_A[:, rows], f_B[:, rows], f_AB[:, :, rows]))
    low, high = np.quantile(np.array(made), (0.025, 0.975), axis=0)
    return low, high
