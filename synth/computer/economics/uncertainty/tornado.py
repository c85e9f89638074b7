"""Tornado: each input alone from its 5 % to its 95 % quantile, all others at their medians."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from synth.computer.economics.uncertainty.model import Model, Ranges, evaluate, points_at, uncertain

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
