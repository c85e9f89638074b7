"""Is the model wrong? What the passes say of laws that it has not, and whether its innovations are as it says;
with Holm's rule for several tests.

Laws: a score test each, with the numbers of the estimate as nuisance, and the size of the effect by one step from 0.
Innovations: those of neighbouring rows must not go together. All tests are clustered by pass, so a pass counts once.

No model is exact, and with thousands of passes the smallest effect is clear. So a test asks whether the effect is
larger than one that matters, not whether it is 0.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from plant_models.frozen_arrays import Floats, Ints
from synth.logs import unknowns as asked
from synth.logs.estimate import STEP, Z95, Estimate, Posterior, posterior
from synth.logs.fitting_passes import FittingPasses
from synth.logs.likelihood import Likelihood


def rejected(p_values: Sequence[float], level: float) -> tuple[int, ...]:
    """Numbers of the tests whose hypothesis falls, the clearest first.

    The chance that any true hypothesis falls is `level` at most, however the tests depend on one another (Holm 1979,
    Scandinavian Journal of Statistics 6, 65–70): the smallest of k p values is held against level / k, the next one
    against level / (k − 1), and so on to the first that does not pass. A NaN never passes.
    """
    order = sorted(range(len(p_values)), key=lambda number: (p_values[number] != p_values[number], p_values[number]))
    passed: list[int] = []
    for place, number in enumerate(order):
        if not p_values[number] * (len(order) - place) <= level:
            break
        passed.append(number)
    return tuple(passed)


SIGNIFICANCE: Final = 0.01
"""Of all tests together (Holm)."""


class Effect(NamedTuple):
    """What a test looks for, the unit of its size, and the size from which on it matters, of either sign."""

    looks_for: str
    unit: str
    matters_from: float


LAWS: Final = {
    asked.FRICTION_BY_SPEED: Effect("friction changes with speed", "% a m/s", 2.0),
    asked.FORCE_BY_PRESSURE: Effect("force is not straight in the pressure", "% at twice 300 kPa", 5.0),
    asked.RESISTANCE_BY_SPEED: Effect("running resistance changes with speed", "% a m/s", 10.0),
}
"""These move the median exit speed of the default tables by about 0.01 m/s at most, a tenth of what acceptance allows
for the rms (docs/how-to/identify.md has the figures)."""

MOTION: Final = Effect("innovations of the speed go together from reading to reading", "m/s", 0.01)
"""The same 0.01 m/s."""

PRESSURE: Final = Effect(
    "innovations of the gauge go together from reading to reading: the drive fills or empties by another law",
    "kPa",
    3.0,
)
"""1 % of the force at 300 kPa: less than any of the laws may be off."""


@dataclass(frozen=True)
class ResidualTest:
    """One test: the `effect` that it looks for, and its size with the 95 % `interval`, in the unit of the effect.

    `z`: statistic for no effect at all, standard normal where there is none. `p`: chance of a size as far from 0 if the
    true one did not matter.
    """

    effect: Effect
    size: float
    interval: tuple[float, float]
    z: float
    p: float

    @property
    def may_matter(self) -> bool:
        """The interval reaches beyond what does not matter."""
        return max(-self.interval[0], self.interval[1]) > self.effect.matters_from


def residual_tests(passes: FittingPasses, found: Estimate, threads: int = 1) -> tuple[ResidualTest, ...]:
    """All tests at the estimate."""
    whole = posterior(passes, found.unknowns, threads)
    return (*law_tests(whole, found), *neighbour_tests(whole, found))


def wrong(tests: tuple[ResidualTest, ...]) -> tuple[ResidualTest, ...]:
    """Those that say that the model is wrong, by Holm's rule, the clearest first."""
    return tuple(tests[number] for number in rejected([test.p for test in tests], SIGNIFICANCE))


def law_tests(whole: Posterior, found: Estimate) -> Iterator[ResidualTest]:
    """A score test for each law beyond the model."""
    there = whole.linearised(found.u)
    solve = np.linalg.inv(np.eye(len(found.u)) + there.information)
    for key, effect in LAWS.items():
        parts = [along(part, found, key) for part in whole.parts]
        score = np.concatenate([own for own, _, _ in parts])
        cross, own_information = sum(cross for _, cross, _ in parts), sum(info for _, _, info in parts)
        # What of the score the numbers of the estimate could not take up.
        clear = score - there.scores @ solve @ cross
        information = float(own_information - cross @ solve @ cross)
        apart = clear - clear.mean()
        size, std = 100.0 * float(clear.sum()) / information, 100.0 * math.sqrt(float(apart @ apart)) / information
        yield ResidualTest(
            effect, size, (size - Z95 * std, size + Z95 * std), size / std, beyond(size, std, effect.matters_from)
        )


def along(part: Likelihood, found: Estimate, key: str) -> tuple[Floats, Floats, float]:
    """Scores of the law `key` by pass, its information with the numbers of the estimate (p,), and its own."""
    values = found.values
    pressures = part.pressures(values)
    base = part.at(values, pressures)
    ends = [part.at(values | {key: sign * STEP}, pressures) for sign in (1.0, -1.0)]
    r, s = base.innovation, base.variance
    by_r = (ends[0].innovation - ends[1].innovation) / (2.0 * STEP)
    by_s = (ends[0].variance - ends[1].variance) / (2.0 * STEP)
    score = np.asarray(
        np.bincount(base.pass_of, -by_r * r / s - 0.5 * by_s / s * (1.0 - r**2 / s), len(part.passes)), dtype=np.float64
    )
    cross = np.empty(len(found.u))
    for j, unknown in enumerate(found.unknowns):
        moved = values | {unknown.key: unknown.value(float(found.u[j]) + STEP)}
        other = part.at(moved, None if unknown.key in asked.OF_VALVES else pressures)
        cross[j] = float((by_r * (other.innovation - r) / s + 0.5 * by_s * (other.variance - s) / s**2).sum()) / STEP
    return score, cross, float((by_r**2 / s + 0.5 * by_s**2 / s**2).sum())


def neighbour_tests(whole: Posterior, found: Estimate) -> Iterator[ResidualTest]:
    """Whether innovations of neighbouring rows go together: by how much they stay away from 0 for longer than a row.

    The mean product of neighbours is the variance of what stays; told is its root, negative where they change sides.
    """
    speed, gauge = [], []
    for part in whole.parts:
        at, passes = part.at(found.values), len(part.passes)
        of_speed, of_gauge = slice(0, at.readings), slice(at.readings, at.readings + at.gauged)
        speed.append(products(at.innovation[of_speed], at.pass_of[of_speed], passes))
        gauge.append(products(at.innovation[of_gauge], at.pass_of[of_gauge], passes))
    for effect, columns in ((MOTION, speed), (PRESSURE, gauge)):
        sums, counts = np.concatenate(columns, axis=1)
        if counts.any():
            mean = float(sums.sum() / counts.sum())
            std = float(np.sqrt(np.sum((sums - mean * counts) ** 2)) / counts.sum())
            yield ResidualTest(
                effect, signed_root(mean), (signed_root(mean - Z95 * std), signed_root(mean + Z95 * std)), mean / std,
                beyond(mean, std, effect.matters_from**2),
            )  # fmt: skip


def products(innovation: Floats, pass_of: Ints, passes: int) -> Floats:
    """Sum of the products of neighbours and their number, by pass, (2, m)."""
    same = pass_of[1:] == pass_of[:-1]
    where, product = pass_of[1:][same], (innovation[1:] * innovation[:-1])[same]
    return np.array([np.bincount(where, product, passes), np.bincount(where, minlength=passes)])


def signed_root(square: float) -> float:
    """√ of the size of `square`, with its sign."""
    return math.copysign(math.sqrt(abs(square)), square)


def beyond(size: float, std: float, most: float) -> float:
    """Chance that an estimate with the standard error `std` is as far from 0 as `size`, if the truth is `most` at most.

    That is where the truth is `most`; for 0 it is the p value of both sides.
    """
    far = abs(size)
    return 0.5 * (math.erfc((far - most) / (std * math.sqrt(2.0))) + math.erfc((far + most) / (std * math.sqrt(2.0))))
