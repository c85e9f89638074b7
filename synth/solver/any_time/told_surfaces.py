"""Surfaces for a regulator that is told the friction of every cut: those of a table, polished anew for each friction.

As `told_lines`, for commands at any time: from the middle outward, each from its neighbour, interpolated in between.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.problem.aim import Aim
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.any_time.sampled_chain import SampledChain
from synth.solver.any_time.surface_evaluation import SurfaceEvaluation
from synth.solver.any_time.surface_polish import NEGLIGIBLE_MASS, polish_surfaces
from synth.solver.coarse_grid import CoarseGridError
from synth.solver.finer_speed import known_factors
from synth.solver.told_lines import SQUARED_ERROR_ALONE, from_the_middle, told_factors

FRICTIONS = 9
"""Values of ξ_cut, from −4 to 4 standard deviations; those that are hardly met keep the table's surfaces."""

LEAST_WEIGHT = 1e-3

ITERATIONS = (4, 2)
"""Of the polish at the mean friction, and at each of the others. More of them find what only the grid knows: with 12
and 4 the rms of 52 t to 3 m/s is 7 % larger in the closed loop."""


@frozen_arrays
class ToldSurfaces:
    """`surfaces`[i] for cuts whose ξ_cut is `factor`[i], (M,), ascending."""

    factor: Floats
    surfaces: tuple[PolynomialSurfaces, ...]

    def at(self, factor: float) -> PolynomialSurfaces:
        """Surfaces for the friction `factor`: linear between neighbours, beyond the ends those of the end.

        Two pairs that keep their distance are joined by pairs that keep it.
        """
        rows = np.array([each.coefficients for each in self.surfaces])
        share = [np.interp(factor, self.factor, row) for row in np.eye(len(self.factor))]
        return replace(self.surfaces[0], coefficients=np.tensordot(share, rows, axes=1))


def told_surfaces(design: SampledChain, target_m_s: float, common: PolynomialSurfaces) -> ToldSurfaces:
    """Surfaces of small mean square error at each of several frictions, on the grid of `design`.

    `common`: surfaces that serve all frictions, to begin with.
    """
    factor, weight = told_factors(design.plant, FRICTIONS)
    aim = Aim(target_m_s, SQUARED_ERROR_ALONE)
    found: dict[int, PolynomialSurfaces] = {}
    evaluation = SurfaceEvaluation(design, negligible_mass=NEGLIGIBLE_MASS)
    for i in from_the_middle(len(factor)):
        start = next((found[j] for j in (i - 1, i + 1) if j in found), common)
        iterations = ITERATIONS[1 if found else 0]
        found[i] = start
        if weight[i] >= LEAST_WEIGHT:
            scenarios = known_factors(design.plant, factor[i : i + 1], design.resolution.resistance_nodes)
            found[i] = improved(replace(evaluation, chain=replace(design, scenarios=scenarios)), aim, start, iterations)
    return ToldSurfaces(factor, tuple(found[i] for i in range(len(factor))))


def improved(evaluation: SurfaceEvaluation, aim: Aim, start: PolynomialSurfaces, iterations: int) -> PolynomialSurfaces:
    """The polished surfaces; `start` where its cost comes out negative, because the grid is too coarse for it."""
    try:
        return polish_surfaces(start, evaluation, aim, iterations).best
    except CoarseGridError:
        return start
