"""Polynomial switching lines: what a polish moves and a table rounds."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, frozen_arrays
from synth.solver.switching_lines import SwitchingLines

MINIMUM_GAP_M_S = 0.04
"""Smallest distance V_hi − V_lo of a fitted pair of lines."""


@frozen_arrays
class PolynomialLines:
    """Lines as Legendre series in x, −1 at `start_m` and 1 at S_exit (well conditioned; tables hold powers of s).

    `coefficients` (K + 1, 2, r + 1): lower, upper; `has_line` (K + 1, 2).
    """

    start_m: float
    exit_m: float
    coefficients: Floats
    has_line: Bools

    @property
    def degree(self) -> int:
        """r."""
        return int(self.coefficients.shape[2]) - 1

    def at(self, nodes_m: Floats) -> SwitchingLines:
        """The lines at path nodes, ±inf where there is none."""
        values: Floats = self.coefficients @ self.basis(nodes_m).T
        lower = np.where(self.has_line[:, 0, None], values[:, 0], -np.inf)
        upper = np.where(self.has_line[:, 1, None], values[:, 1], np.inf)
        return SwitchingLines(np.array(nodes_m), lower, upper)

    def powers_of_s(self) -> Floats:
        """Ascending coefficients in powers of s in metres, (K + 1, 2, r + 1)."""
        powers: Floats = self.coefficients @ basis_in_powers(self.start_m, self.exit_m, self.degree)
        return powers

    def basis(self, nodes_m: Floats) -> Floats:
        """Legendre polynomials at the nodes, (nodes, r + 1)."""
        return basis(nodes_m, self.start_m, self.exit_m, self.degree)

    def nodes_m(self, count: int) -> Floats:
        """Equally spaced path nodes over the whole path of the lines."""
        return np.linspace(self.start_m, self.exit_m, count)


def basis(nodes_m: Floats, start_m: float, exit_m: float, degree: int) -> Floats:
    """Legendre polynomials at the nodes, (nodes, r + 1)."""
    x = 2.0 * (nodes_m - start_m) / (exit_m - start_m) - 1.0
    return np.asarray(np.polynomial.legendre.legvander(x, degree), dtype=np.float64)


@lru_cache(maxsize=32)
def basis_in_powers(start_m: float, exit_m: float, degree: int) -> Floats:
    """Ascending coefficients in powers of s in metres of every Legendre polynomial, (r + 1, r + 1)."""
    found = np.zeros((degree + 1, degree + 1))
    for order in range(degree + 1):
        series = np.polynomial.legendre.Legendre.basis(order, domain=[start_m, exit_m])
        power = series.convert(kind=np.polynomial.Polynomial, domain=[-1.0, 1.0])
        found[order, : len(power.coef)] = power.coef
    found.setflags(write=False)
    return found


def gap_of(lines: PolynomialLines) -> float:
    """Smallest V_hi − V_lo over stages and a fine path mesh."""
    at = lines.at(lines.nodes_m(201))
    return float((at.upper_m_s - at.lower_m_s).min())


def opened(lines: PolynomialLines) -> PolynomialLines:
    """The lines with every pair moved apart, symmetrically, until its gap is at least the minimum.

    The same object where nothing need be moved.
    """
    at = lines.at(lines.nodes_m(201))
    short = MINIMUM_GAP_M_S - (at.upper_m_s - at.lower_m_s).min(axis=1)
    if not (short > 0.0).any():
        return lines
    coefficients = lines.coefficients.copy()
    for k in np.nonzero(short > 0.0)[0]:
        coefficients[k, 0, 0] -= 0.5 * short[k]
        coefficients[k, 1, 0] += 0.5 * short[k]
    return replace(lines, coefficients=coefficients)
