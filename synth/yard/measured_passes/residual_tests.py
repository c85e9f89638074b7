"""Is the model wrong? What the passes say of laws that it has not, and whether its surprises are as it says.

Laws: a score test each, with the numbers of the estimate as nuisance, and the size of the effect by one step from 0.
Surprises: those of neighbouring rows must not go together. All tests are clustered by pass, so a pass counts once.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from synth.yard.measured_passes import unknowns as asked
from synth.yard.measured_passes.estimate import STEP, Estimate, Posterior, posterior
from synth.yard.measured_passes.fitting_passes import FittingPasses
from synth.yard.measured_passes.holm import rejected
from synth.yard.measured_passes.likelihood import Likelihood

Floats = NDArray[np.float64]

SIGNIFICANCE = 0.01
"""Of all tests together (Holm)."""

BEYOND = {
    asked.FRICTION_BY_SPEED: ("friction changes with speed", "1 a m/s"),
    asked.FORCE_BY_PRESSURE: ("force is not straight in the pressure", "1 at twice 300 kPa"),
    asked.RESISTANCE_BY_SPEED: ("running resistance changes with speed", "1 a m/s"),
}

MOTION, PRESSURE = (
    "surprises of the speed go together from reading to reading",
    ("surprises of the gauge go together from reading to reading: the drive fills or empties by another law"),
)


@dataclass(frozen=True)
class ResidualTest:
    """One test: what it looks for, its statistic z (standard normal where the model is right) and the p value.

    `size`, `size_std`, `unit`: of the effect, NaN where the test tells none.
    """

    looks_for: str
    z: float
    p: float
    size: float = math.nan
    size_std: float = math.nan
    unit: str = ""


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
    for key, (looks_for, unit) in BEYOND.items():
        parts = [along(part, found, key) for part in whole.parts]
        score = np.concatenate([own for own, _, _ in parts])
        cross, own_information = sum(cross for _, cross, _ in parts), sum(info for _, _, info in parts)
        # What of the score the numbers of the estimate could not take up.
        clear = score - there.scores @ solve @ cross
        information = float(own_information - cross @ solve @ cross)
        spread = math.sqrt(float(clear @ clear))
        z = float(clear.sum()) / spread
        yield ResidualTest(looks_for, z, two_sided(z), float(clear.sum()) / information, spread / information, unit)


def along(part: Likelihood, found: Estimate, key: str) -> tuple[Floats, Floats, float]:
    """Scores of the law `key` by pass, its information with the numbers of the estimate (p,), and its own."""
    values = found.values
    pressures = part.pressures(values)
    base = part.at(values, pressures)
    ends = [part.at(values | {key: sign * STEP}, pressures) for sign in (1.0, -1.0)]
    r, s = base.surprise, base.variance
    by_r = (ends[0].surprise - ends[1].surprise) / (2.0 * STEP)
    by_s = (ends[0].variance - ends[1].variance) / (2.0 * STEP)
    score = np.asarray(
        np.bincount(base.pass_of, -by_r * r / s - 0.5 * by_s / s * (1.0 - r**2 / s), len(part.passes)), dtype=np.float64
    )
    cross = np.empty(len(found.u))
    for j, unknown in enumerate(found.unknowns):
        moved = values | {unknown.key: unknown.value(float(found.u[j]) + STEP)}
        other = part.at(moved, None if unknown.key in asked.OF_VALVES else pressures)
        cross[j] = float((by_r * (other.surprise - r) / s + 0.5 * by_s * (other.variance - s) / s**2).sum()) / STEP
    return score, cross, float((by_r**2 / s + 0.5 * by_s**2 / s**2).sum())


def neighbour_tests(whole: Posterior, found: Estimate) -> Iterator[ResidualTest]:
    """Whether standardised surprises of neighbouring rows go together."""
    speed: list[Floats] = []
    gauge: list[Floats] = []
    for part in whole.parts:
        at = part.at(found.values)
        z = at.surprise / np.sqrt(at.variance)
        ends = at.readings, at.readings + at.gauged
        speed.append(products(z[: ends[0]], at.pass_of[: ends[0]], len(part.passes)))
        gauge.append(products(z[ends[0] : ends[1]], at.pass_of[ends[0] : ends[1]], len(part.passes)))
    for looks_for, columns in ((MOTION, speed), (PRESSURE, gauge)):
        sums = np.concatenate(columns)
        if sums.any():
            z_all = float(sums.sum() / math.sqrt(float(sums @ sums)))
            yield ResidualTest(looks_for, z_all, two_sided(z_all))


def products(z: Floats, pass_of: NDArray[np.int64], passes: int) -> Floats:
    """Sum of the products of neighbours, by pass."""
    same = pass_of[1:] == pass_of[:-1]
    return np.asarray(np.bincount(pass_of[1:][same], (z[1:] * z[:-1])[same], passes))


def two_sided(z: float) -> float:
    """p value of a standard normal `z`."""
    return math.erfc(abs(z) / math.sqrt(2.0))
