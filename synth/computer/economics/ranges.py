"""How far an input is known: a distribution, told by its quantiles; and the function whose inputs are uncertain,
evaluated at many points.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from plant_models.errors import PlantError, require
from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.frame.interval import Interval

NORMAL_90, NORMAL_95 = 1.6448536269514722, 1.959963984540054
"""95 and 97.5 % quantiles of the normal law."""


class Range(Protocol):
    """A distribution of one input."""

    def quantile(self, p: Floats) -> Floats:
        """The value that the share `p` of all draws stays under; p in [0, 1], any shape."""
        ...


@dataclass(frozen=True)
class Constant:
    """An input that is known."""

    value: float

    def quantile(self, p: Floats) -> Floats:
        """`value`."""
        return np.full_like(p, self.value)


@dataclass(frozen=True)
class Uniform:
    """Anything from `low` to `high` alike; `PlantError` unless low < high."""

    low: float
    high: float

    def __post_init__(self) -> None:
        require_rising("uniform", self.low, self.high)

    def quantile(self, p: Floats) -> Floats:
        """low + p·(high − low)."""
        return self.low + p * (self.high - self.low)


@dataclass(frozen=True)
class Triangular:
    """From `low` to `high`, `mode` most likely; it may lie at an end. `PlantError` unless low ≤ mode ≤ high, low <
    high."""

    low: float
    mode: float
    high: float

    def __post_init__(self) -> None:
        require_rising("triangular", self.low, self.high)
        require(
            self.low <= self.mode <= self.high,
            f"the mode {self.mode!r} of a triangular range must lie from {self.low!r} to {self.high!r}",
        )

    def quantile(self, p: Floats) -> Floats:
        """Inverse of the two parabolas of the distribution function."""
        width, left, right = self.high - self.low, self.mode - self.low, self.high - self.mode
        rising = self.low + np.sqrt(p * width * left)
        falling = self.high - np.sqrt((1.0 - p) * width * right)
        return np.where(p * width < left, rising, falling)


@dataclass(frozen=True)
class LogNormal:
    """A positive input whose logarithm is normal, by its 5 and 95 % quantiles; `PlantError` unless 0 < q05 < q95."""

    q05: float
    q95: float

    def __post_init__(self) -> None:
        require_rising("lognormal", self.q05, self.q95)
        require(self.q05 > 0.0, f"the 5 % quantile {self.q05!r} of a lognormal range must be above 0")

    def quantile(self, p: Floats) -> Floats:
        """exp(μ + σ·z(p))."""
        from scipy.special import ndtri  # start-up: scipy only where it is needed

        middle = 0.5 * (math.log(self.q05) + math.log(self.q95))
        spread = 0.5 * (math.log(self.q95) - math.log(self.q05)) / NORMAL_90
        return np.asarray(np.exp(middle + spread * ndtri(p)))


@dataclass(frozen=True)
class Measured:
    """A figure with its 95 % interval: median `value`, 2.5 and 97.5 % quantiles `low95` and `high95`.

    Normal below and above the median, each with its own spread. `PlantError` unless low95 ≤ value ≤ high95, low95 <
    high95.
    """

    value: float
    low95: float
    high95: float

    def __post_init__(self) -> None:
        require_rising("measured", self.low95, self.high95)
        require(
            self.low95 <= self.value <= self.high95,
            f"the figure {self.value!r} must lie in its interval from {self.low95!r} to {self.high95!r}",
        )

    def quantile(self, p: Floats) -> Floats:
        """value + z(p)/1.96 times the half of the interval on this side."""
        from scipy.special import ndtri  # start-up: scipy only where it is needed

        z = ndtri(p) / NORMAL_95
        return np.where(
            z < 0.0, self.value + z * (self.value - self.low95), self.value + z * (self.high95 - self.value)
        )


def range_of(estimate: Interval) -> Range:
    """The range of a measured figure; constant where its interval has no width."""
    if estimate.low95 == estimate.high95:
        return Constant(estimate.value)
    return Measured(estimate.value, estimate.low95, estimate.high95)


def require_rising(kind: str, low: float, high: float) -> None:
    """Raise `PlantError` unless both are finite and low < high."""
    require(
        math.isfinite(low) and math.isfinite(high) and low < high,
        f"the {kind} range goes from {low!r} to {high!r}; both must be finite and the first below the second",
    )


Model = Callable[[Mapping[str, float]], Mapping[str, float]]
"""Named inputs to named outputs, always the same names. Infinite: never. `PlantError`: these inputs are impossible."""

Ranges = Mapping[str, Range]


@frozen_arrays
class Evaluations:
    """Outputs at n points: `values` (outputs, n), NaN where the inputs were impossible; `faults`: how many of these
    gave which sentence, the most frequent first (of sentences that differ in numbers alone, the first one stands for
    all)."""

    outputs: tuple[str, ...]
    values: Floats
    faults: tuple[tuple[str, int], ...]

    def __getitem__(self, output: str) -> Floats:
        """The values (n,) of one output; `PlantError` for a name that the function does not give."""
        require(output in self.outputs, f"{output!r} is no output; there are {', '.join(self.outputs)}")
        values: Floats = self.values[self.outputs.index(output)]
        return values


def evaluate(model: Model, names: tuple[str, ...], points: Floats) -> Evaluations:
    """The outputs of `model` at `points` (inputs, n); `PlantError` where no point is possible."""
    rows: list[Mapping[str, float] | None] = []
    faults: Counter[str] = Counter()
    sentences: dict[str, str] = {}
    for point in points.T.tolist():
        try:
            rows.append(model(dict(zip(names, point, strict=True))))
        except PlantError as fault:
            rows.append(None)
            kind = without_numbers(str(fault))
            sentences.setdefault(kind, str(fault))
            faults[kind] += 1
    made = next((row for row in rows if row is not None), None)
    if made is None:
        raise PlantError(f"no draw of the inputs is possible; the first one: {next(iter(sentences.values()))}")
    outputs = tuple(made)
    values = np.array([[math.nan if row is None else row[name] for row in rows] for name in outputs], dtype=float)
    return Evaluations(outputs, values, tuple((sentences[kind], n) for kind, n in faults.most_common()))


def without_numbers(sentence: str) -> str:
    """A sentence with its digits, signs and points left out, so that alike faults are counted together."""
    return "".join(letter for letter in sentence if letter not in "0123456789.+-")


def uncertain(ranges: Ranges) -> tuple[str, ...]:
    """The names of inputs that are no constant, sorted; `PlantError` if there is none."""
    names = tuple(sorted(name for name, each in ranges.items() if not isinstance(each, Constant)))
    require(bool(names), "no input has a range; an interval of the outputs needs one at least")
    return names


def points_at(ranges: Ranges, p: Mapping[str, Floats], n: int) -> tuple[tuple[str, ...], Floats]:
    """Names and points (inputs, n): each input at its quantile `p[name]` (n,), its median where `p` does not tell
    it."""
    names = tuple(sorted(ranges))
    middle = np.full(n, 0.5)
    return names, np.array([ranges[name].quantile(p.get(name, middle)) for name in names])
