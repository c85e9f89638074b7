"""Switching surfaces of few coefficients: for every stage and side, a polynomial of the path and of the pressure."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from synth.solver.any_time.drive_modes import DriveModes
from synth.solver.switching_lines import PolynomialLines, basis

PRESSURE_UNIT_KPA = 100.0
"""Powers of the pressure count in it."""

CUBIC_AND_SLOPE = (3, 0)
"""Degrees in the path for the powers of the pressure: a cubic, and one slope."""

CUBIC_ALONE = (3,)
"""For regulators that do not know their pressure."""


@frozen_arrays
class PolynomialSurfaces:
    """V_lo,k and V_hi,k = Σ_i x^i · Σ_j a_ij·L_j(u), x = (P − P_k) / 100 kPa; u is −1 at `start_m` and 1 at S_exit.

    L_j are Legendre polynomials, and P is held within the pressures of the stages. `stage_kpa` (K + 1,) pressures P_k;
    `degrees`: of the path, for each power i. `coefficients` (K + 1, 2, T): lower, upper, power after power; `has_line`
    (K + 1, 2).
    """

    start_m: float
    exit_m: float
    stage_kpa: Floats
    degrees: tuple[int, ...]
    coefficients: Floats
    has_line: Bools

    @property
    def lines(self) -> Ints:
        """(stage, side) of the surfaces that there are, (·, 2)."""
        return np.argwhere(self.has_line)

    def terms(self, nodes_m: Floats, stage: int, pressure_kpa: Floats) -> Floats:
        """What the coefficients of `stage` are multiplied by at path nodes and pressures, (N, B, T)."""
        held = np.clip(pressure_kpa, self.stage_kpa[0], self.stage_kpa[-1])
        x = (held - self.stage_kpa[stage]) / PRESSURE_UNIT_KPA
        parts = [
            basis(nodes_m, self.start_m, self.exit_m, degree)[:, None, :] * (x**power)[None, :, None]
            for power, degree in enumerate(self.degrees)
        ]
        return np.concatenate(parts, axis=2)

    def at(self, nodes_m: Floats, modes: DriveModes) -> Floats:
        """The lines (2, N, M) at path nodes and modes, ±inf where there is none."""
        found = np.empty((2, len(nodes_m), len(modes.stage)))
        found[0], found[1] = -np.inf, np.inf
        for stage, side in self.lines:
            here = np.flatnonzero(modes.stage == stage)
            terms = self.terms(nodes_m, int(stage), modes.pressure_kpa[here])
            found[side][:, here] = terms @ self.coefficients[stage, side]
        return found

    @property
    def has_slopes(self) -> bool:
        """Whether the lines depend on the pressure."""
        return len(self.degrees) > 1

    def at_stage_pressures(self) -> PolynomialLines:
        """The lines of every stage at its own pressure."""
        coefficients = self.coefficients[:, :, : self.degrees[0] + 1]
        return PolynomialLines(self.start_m, self.exit_m, coefficients, np.array(self.has_line))

    def slopes_m_s_per_kpa(self) -> Floats:
        """Those of the lines over the pressure, (K + 1, 2); `ValueError` where they are not the same at every path."""
        if self.degrees[1:] != (0,):
            raise ValueError(f"surfaces of degrees {self.degrees} have no slope that is the same at every path")
        return self.coefficients[:, :, -1] / PRESSURE_UNIT_KPA


def surfaces_of_lines(
    lines: PolynomialLines, stage_kpa: Floats, degrees: tuple[int, ...] = CUBIC_AND_SLOPE
) -> PolynomialSurfaces:
    """Stage-locked lines at every pressure of their stage."""
    count = sum(degree + 1 for degree in degrees)
    coefficients = np.zeros((*lines.has_line.shape, count))
    shared = min(lines.degree, degrees[0]) + 1
    coefficients[:, :, :shared] = lines.coefficients[:, :, :shared]
    return PolynomialSurfaces(lines.start_m, lines.exit_m, stage_kpa, degrees, coefficients, np.array(lines.has_line))


def moved_apart(surfaces: PolynomialSurfaces, by_m_s: Floats) -> PolynomialSurfaces:
    """Every pair moved apart by `by_m_s` (K + 1,), half of it each."""
    coefficients = np.array(surfaces.coefficients)
    coefficients[:, 0, 0] -= 0.5 * by_m_s
    coefficients[:, 1, 0] += 0.5 * by_m_s
    return replace(surfaces, coefficients=coefficients)
