"""Switching lines V_lo,k(s) and V_hi,k(s) over path nodes and stages (the switching matrices of zhukovitsky-2002),
and as polynomials: what a polish moves and a table rounds.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, frozen_arrays
from synth.solver.chain.decisions import Decisions


@frozen_arrays
class SwitchingLines:
    """Below `lower_m_s[k]` go down, above `upper_m_s[k]` go up, between them hold.

    A command goes on, as far as it may, to the stage at which the same speed no longer asks for the next.

    `nodes_m` (N + 1,) increasing from 0 to S_exit, equally spaced; `lower_m_s` and `upper_m_s` of shape
    (K + 1, N + 1), linear between nodes; −inf / +inf where the stage has no such command.
    """

    nodes_m: Floats
    lower_m_s: Floats
    upper_m_s: Floats

    def __post_init__(self) -> None:
        if self.lower_m_s.shape != self.upper_m_s.shape or self.lower_m_s.shape[1:] != self.nodes_m.shape:
            raise ValueError(
                f"switching lines: shapes {self.lower_m_s.shape} and {self.upper_m_s.shape} do not fit "
                f"{self.nodes_m.shape[0]} path nodes"
            )

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return int(self.lower_m_s.shape[0])

    def at_decisions(self, decisions: Decisions) -> Floats:
        """The lines (C, R, K + 1); the nodes must be those of the path.

        By d stages or more a command goes where the speed is beyond the lines of d stages on end: below the lowest of
        the lower ones, above the highest of the upper ones.
        """
        lower, upper = self.lower_m_s[:, decisions.node], self.upper_m_s[:, decisions.node]
        found = np.empty((decisions.commands, *lower.T.shape))
        for d, (down, up) in enumerate(zip(found[0::2], found[1::2], strict=True), start=1):
            down[:], up[:] = -np.inf, np.inf
            for k in range(d, self.stages):
                down[:, k] = lower[k - d + 1 : k + 1].min(axis=0)
                up[:, k - d] = upper[k - d : k].max(axis=0)
        return found

    def slopes(self, decisions: Decisions, by_command: Floats) -> Floats:
        """Derivatives by the lower and the upper lines, (I, 2, R, K + 1): of a command by the line that decides."""
        lower, upper = self.lower_m_s[:, decisions.node], self.upper_m_s[:, decisions.node]
        found = np.zeros((len(by_command), 2, *lower.T.shape))
        places = np.arange(len(decisions))
        for d in range(1, decisions.farthest + 1):
            for k in range(d, self.stages):
                first, above = k - d + 1, k - d
                down, up = lower[first : k + 1].argmin(axis=0) + first, upper[above:k].argmax(axis=0) + above
                found[:, 0, places, down] += by_command[:, 2 * d - 2, :, k]
                found[:, 1, places, up] += by_command[:, 2 * d - 1, :, above]
        return found

    def at(self, nodes_m: Floats) -> SwitchingLines:
        """The same lines at other path nodes."""
        lower, upper = (
            np.array([np.interp(nodes_m, self.nodes_m, line) for line in side])
            for side in (self.lower_m_s, self.upper_m_s)
        )
        return SwitchingLines(np.array(nodes_m), lower, upper)


def always_up(nodes_m: Floats, stages: int) -> SwitchingLines:
    """Lines of so many stages below every speed: each decision raises, as far as there is a stage and it may."""
    lower, upper = np.full((stages, len(nodes_m)), -np.inf), np.full((stages, len(nodes_m)), -1.0)
    upper[-1] = np.inf
    return SwitchingLines(nodes_m, lower, upper)


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
