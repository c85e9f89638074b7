"""The function whose inputs are uncertain, evaluated at many points."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping

import numpy as np

from plant_models.errors import PlantError, require
from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.computer.economics.uncertainty.ranges import Constant, Range

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
