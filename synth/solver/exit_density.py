"""The distribution of the exit speed that a policy is predicted to give."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays


@frozen_arrays
class ExitDensity:
    """Distribution at the exit: `probability` (E,) at `speed_m_s` (E,), the rest as probabilities or means.

    `escaped` is mass that ran off the top of the grid somewhere; it should be zero.
    """

    speed_m_s: Floats
    probability: Floats
    stalled: float
    escaped: float
    switchings: float

    def rms_m_s(self, target_speed_m_s: float) -> float:
        """Root mean square exit-speed error; a stall counts as exit speed 0."""
        square = (self.probability * (self.speed_m_s - target_speed_m_s) ** 2).sum()
        return float(np.sqrt(max(square + self.stalled * target_speed_m_s**2, 0.0)))

    def bias_m_s(self, target_speed_m_s: float) -> float:
        """Mean exit-speed error; a stall counts as exit speed 0."""
        first = (self.probability * (self.speed_m_s - target_speed_m_s)).sum()
        return float(first - self.stalled * target_speed_m_s)

    def p_overspeed(self, limit_m_s: float) -> float:
        """P(exit speed > limit), the probabilities taken as points of a density and joined as the recursion does it."""
        energy = 0.5 * self.speed_m_s**2
        share = share_beyond((0.5 * limit_m_s**2 - energy) / energy[1])
        return min(max(float(self.probability @ share), 0.0), 1.0)


def share_beyond(cells: Floats) -> Floats:
    """Integral from `cells` to infinity of the cubic Lagrange function, by which four points of a grid interpolate."""
    near = np.minimum(np.abs(cells), 1.0)
    far = np.clip(np.abs(cells) - 1.0, 0.0, 1.0)
    within: Floats = near * (1.0 - near * (0.25 + near * (1.0 / 3.0 - 0.125 * near)))
    within = within - far**2 * (1.0 - far * (1.0 - 0.25 * far)) / 6.0
    return np.where(cells < 0.0, 0.5 + within, 0.5 - within)


CORE = 1e-3
"""Where a probability has this share of the largest, it may be changed for those that were negative."""

NEWTON_STEPS = 30
"""Far more than are needed where little is negative; so many where no distribution has the moments."""


def without_negative(density: ExitDensity) -> ExitDensity:
    """The same with no probability below 0, of equal mass, mean and mean square; unchanged if there is none.

    Cubic weights leave negative probabilities where a density is narrow for its grid. Each becomes 0; and the core of
    the density is multiplied by the exponential of a parabola, so that all three moments are what they were. Of all
    that keep them this is the core nearest to what it was, by relative entropy. The tails stay as they are.
    """
    if density.probability.min(initial=0.0) >= 0.0:
        return density
    positive = np.maximum(density.probability, 0.0)
    core = positive > CORE * positive.max()
    middle = np.average(density.speed_m_s[core], weights=positive[core])
    width = np.sqrt(np.average((density.speed_m_s[core] - middle) ** 2, weights=positive[core]))
    x = (density.speed_m_s - middle) / max(width, 1e-9)
    powers = np.stack([np.ones_like(x), x, x * x])
    moments = powers @ (density.probability - np.where(core, 0.0, positive))
    positive[core] = tilted(positive[core], powers[:, core], moments)
    return replace(density, probability=positive)


def tilted(weight: Floats, powers: Floats, moments: Floats) -> Floats:
    """`weight` (E,) times exp(λ·`powers`), λ such that the sums with `powers` (3, E) are `moments`: Newton's method.

    The λ sought minimises the convex Σ weight·exp(λ·powers) − λ·moments; a step that does not lower it is halved.
    """

    def at(place: Floats) -> tuple[Floats, float]:
        found = weight * np.exp(np.minimum(place @ powers, 100.0))
        return found, float(found.sum() - place @ moments)

    place = np.zeros(len(moments))
    found, height = at(place)
    for _ in range(NEWTON_STEPS):
        slope = powers @ found - moments
        step = np.linalg.lstsq((powers * found) @ powers.T, slope)[0]
        if abs(slope @ step) < 1e-24:
            break
        share = 1.0
        while share > 1e-6:
            ahead, lower = at(place - share * step)
            if lower <= height:
                break
            share *= 0.5
        place, found, height = place - share * step, ahead, lower
    return found
