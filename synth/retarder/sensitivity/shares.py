"""Shares of variance: what part of the variance of an output each input alone accounts for.

First-order shares V(E(Y | X_i)) / V(Y) answer which input to measure first: the share is the part of the variance that
is expected to go once X_i is known (Saltelli et al. 2004, *factor prioritisation*). They are estimated from given
points by random balance designs (Tarantola, Gatelli and Mara 2006; Plischke 2010) with the correction of Tissot and
Prieur (2012). A bootstrap would draw points twice, which this method sees as noise; the intervals here come from
leaving out a tenth of the points at a time (jackknife), and hold for sums and means too.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Bools, Floats, frozen_arrays
from synth.simulation.replicates import Interval, student_quantile

HARMONICS: Final = 6
"""Of the response to one input: M of Tarantola et al.; more see sharper bends, and more noise."""

GROUPS: Final = 10
"""Parts of the points that are left out in turn."""

FEWEST_POINTS: Final = 200
"""Of a hypercube: with fewer, no share under a tenth is decidable."""


@dataclass(frozen=True)
class Share:
    """A share of the variance and its 95 % interval, which may reach below 0 and above 1, as the estimate may."""

    value: float
    ci95: Interval

    @property
    def decided(self) -> bool:
        """The interval leaves out 0."""
        return self.ci95[0] > 0.0


@frozen_arrays
class Estimates:
    """Estimates (n,) from all points, and (`GROUPS`, n) from all but one group of them each."""

    whole: Floats
    without: Floats

    def share(self, place: int) -> Share:
        """Estimate number `place` with its interval."""
        return with_interval(float(self.whole[place]), self.without[:, place])

    @property
    def rest(self) -> Estimates:
        """1 − their sum, as the one estimate."""
        return Estimates(1.0 - self.whole.sum(keepdims=True), 1.0 - self.without.sum(axis=1, keepdims=True))


def with_interval(value: float, without: Floats) -> Share:
    """`value` with the interval that the estimates `without` a group each tell (jackknife of groups)."""
    count = len(without)
    square = (count - 1) / count * float(np.square(without - without.mean()).sum())
    half = student_quantile(count - 1) * square**0.5
    return Share(value, (value - half, value + half))


def jackknifed(estimate: Callable[[Bools], Floats], points: int) -> Estimates:
    """`estimate` of all points, and without each group: every tenth point, so each is spread over the cube."""
    place = np.arange(points) % GROUPS
    without = [estimate(place != group) for group in range(GROUPS)]
    return Estimates(estimate(np.ones(points, dtype=np.bool_)), np.array(without))


def first_order(unit: Floats, output: Floats) -> Estimates:
    """Shares of the inputs (n, d) in the variance of `output` (n,); 0 where it does not vary.

    The inputs are independent, each uniform; points of a Latin hypercube do. `ValueError` for too few.
    """
    if len(output) < FEWEST_POINTS:
        raise ValueError(f"sensitivity: {len(output)} points; at least {FEWEST_POINTS} are needed")
    return jackknifed(lambda kept: balanced(unit[kept], output[kept]), len(output))


def balanced(unit: Floats, output: Floats) -> Floats:
    """Shares (d,) by random balance designs."""
    if np.ptp(output) == 0.0:
        return np.zeros(unit.shape[1])
    return without_bias(np.array([low_harmonics(output[there_and_back(x)]) for x in unit.T]), len(output))


def there_and_back(x: Floats) -> NDArray[np.intp]:
    """The order in which one input rises over every second point and falls back over the others.

    Along it a response to the input is one period of a function without a jump; what the others do is noise.
    """
    rising = np.argsort(x)
    return np.concatenate([rising[::2], rising[1::2][::-1]])


def low_harmonics(y: Floats) -> float:
    """What part of the variance of `y` (n,) its `HARMONICS` slowest harmonics make, by Parseval's theorem.

    Each of them counts twice, for its negative frequency too: n is at least 2 · `HARMONICS` + 1.
    """
    apart = y - y.mean()
    power = np.square(np.abs(np.fft.rfft(apart)[1 : HARMONICS + 1]))
    return float(2.0 * power.sum() / (len(y) * np.square(apart).sum()))


def without_bias(raw: Floats, points: int) -> Floats:
    """Shares less the bias that Tissot and Prieur (2012) derive.

    Noise is alike in all frequencies, so the harmonics hold λ = 2·`HARMONICS` / `points` of it: raw = S + λ(1 − S).
    """
    of_noise = 2.0 * HARMONICS / points
    return (raw - of_noise) / (1.0 - of_noise)


def noise_share(output: Floats, again: Floats) -> Estimates:
    """What part of the variance of `output` (n,) is the draw of the passes, from the first points simulated `again`.

    `again` (m,) has other passes, the same at every point. What they shift at all points alike is no variance between
    points, so half the variance of the differences is what counts.
    """
    difference, variance = output[: len(again)] - again, float(output.var())

    def share(kept: Bools) -> Floats:
        return np.array([0.5 * float(difference[kept].var(ddof=1)) / variance if variance > 0.0 else 0.0])

    return jackknifed(share, len(again))


def mean_estimates(several: Sequence[Estimates]) -> Estimates:
    """Means over several outputs at the same points; their errors are dependent, and the groups keep that."""
    return Estimates(np.mean([e.whole for e in several], axis=0), np.mean([e.without for e in several], axis=0))
