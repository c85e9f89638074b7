"""The error of an estimated speed along the path: what the hidden constants of a pass shift, and noise about it.

An estimator does not learn the running resistance, and learns the friction by and by. Both enter its error and the
motion alike, so they are no noise that the next sample takes away: each scenario has its own shift.
"""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.solver.chain.scenarios import Scenarios

LEAST_OBSERVATIONS = 50
"""A section of the path with fewer has the figures of the whole path."""

Observed = Floats
"""Rows of path, error, ξ_cut − 1, acceleration by w − E w, weight: (n, 5)."""


@frozen_arrays
class EstimateError:
    """Of an estimated speed at `path_m` (R,), linear in between: its noise and its shifts.

    `std_m_s` (R,) of the noise, taken as white; `per_friction` (R,) m/s of shift per 1 of ξ_cut − 1;
    `per_acceleration_s` (R,) m/s of shift per m/s² that the running resistance adds to the acceleration.
    """

    path_m: Floats
    std_m_s: Floats
    per_friction: Floats
    per_acceleration_s: Floats

    def noise_m_s(self, path_m: Floats) -> Floats:
        """Standard deviation of the noise at places of the path."""
        return np.interp(path_m, self.path_m, self.std_m_s)

    def shift_m_s(self, path_m: Floats, scenarios: Scenarios, i: int) -> Floats:
        """Mean of estimated minus true speed in scenario `i`."""
        by_friction = np.interp(path_m, self.path_m, self.per_friction) * (scenarios.factor[i] - 1.0)
        by_resistance = np.interp(path_m, self.path_m, self.per_acceleration_s) * scenarios.extra_m_s2[i]
        return np.asarray(by_friction + by_resistance)


def error_along_path(observed: Observed, edges_m: Floats, least_std_m_s: float) -> EstimateError:
    """Fit of `observed`, in each section between `edges_m` (R + 1,) for itself.

    No noise is smaller than `least_std_m_s`: what is left of an error is not white, and a smaller one would ask for a
    finer grid.
    """
    section = np.searchsorted(edges_m, observed[:, 0], side="right") - 1
    found = []
    for number in range(len(edges_m) - 1):
        here = observed[section == number]
        found.append(shifts_and_std(here if len(here) >= LEAST_OBSERVATIONS else observed))
    per_friction, per_acceleration, std = np.array(found).T
    middle = 0.5 * (edges_m[1:] + edges_m[:-1])
    return EstimateError(middle, np.maximum(std, least_std_m_s), per_friction, per_acceleration)


def shifts_and_std(observed: Observed) -> tuple[float, float, float]:
    """Weighted least squares without a constant: (per friction, per acceleration, rms of what is left)."""
    root = np.sqrt(observed[:, 4])
    hidden, error = observed[:, 2:4] * root[:, None], observed[:, 1] * root
    shifts = np.linalg.lstsq(hidden, error, rcond=None)[0]
    left = float(np.sqrt(((error - hidden @ shifts) ** 2).sum() / observed[:, 4].sum()))
    return float(shifts[0]), float(shifts[1]), left
