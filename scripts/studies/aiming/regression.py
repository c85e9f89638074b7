"""Refinement as an engineer would fit it: a polynomial of the reading, less a margin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial

from plant_models.errors import require
from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.aim.knowledge import Requirement
from synth.aim.limit_speed import bounded
from synth.aim.readings import Reading
from synth.aim.scene import SceneCuts


@frozen_arrays
class CommandsByPolynomial:
    """`polynomials` of the reading, one for each place, margin included; readings beyond `range` count as its ends."""

    reading: Reading
    polynomials: tuple[Polynomial, ...]
    range: tuple[float, float]
    bounds_m_s: tuple[float, float]

    def of(self, cuts: SceneCuts) -> Floats:
        """By the readings of these cuts, (n, k)."""
        told = np.clip(self.reading.of(cuts).with_error(cuts), *self.range)
        return bounded(np.stack([p(told) for p in self.polynomials], axis=1), self.bounds_m_s)


@dataclass(frozen=True)
class ByRegression:
    """Category, cars and a reading: least squares of the thresholds on a polynomial of `degree` of the reading; one
    margin for each place keeps the requirement on average over the cuts, not for every reading."""

    reading: Reading
    degree: int = 2

    def __post_init__(self) -> None:
        require(1 <= self.degree <= 6, f"regression: degree is {self.degree}; it must be from 1 to 6")

    def commands(self, cuts: SceneCuts, thresholds_m_s: Floats, requirement: Requirement) -> CommandsByPolynomial:
        """Fit and margin on these cuts; cuts that couple too fast whatever is commanded choose the margin only."""
        told = self.reading.of(cuts).with_error(cuts)
        low, high = np.quantile(told, (0.001, 0.999))
        told = np.clip(told, low, high)
        fitted = tuple(self.fitted(told, column, requirement.p_overspeed) for column in thresholds_m_s.T)
        return CommandsByPolynomial(self.reading, fitted, (float(low), float(high)), requirement.bounds_m_s)

    def fitted(self, told: Floats, thresholds_m_s: Floats, p_overspeed: float) -> Polynomial:
        """The polynomial for one place, lowered by the margin."""
        able = np.isfinite(thresholds_m_s)
        fit = Polynomial.fit(told[able], thresholds_m_s[able], self.degree)
        return fit - np.quantile(fit(told) - thresholds_m_s, 1.0 - p_overspeed, method="higher")
