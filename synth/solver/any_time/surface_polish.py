"""The polish of switching surfaces: the exactly evaluated cost, minimised over all coefficients at once.

For all frictions, and anew for each friction, for a regulator that is told it: as `told_lines`, from the middle
outward, each from its neighbour, interpolated in between.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.problem.problem import Aim
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces, moved_apart
from synth.solver.any_time.sampled_chain import SampledChain
from synth.solver.any_time.surface_evaluation import SurfaceCost, SurfaceEvaluation
from synth.solver.chain.chain import known_factors
from synth.solver.descent import (
    OWN_GRID,
    CoarseGridError,
    CostAndSlopes,
    Descent,
    descend,
    one_blas_thread,
    require_positive,
)
from synth.solver.switching_lines import MINIMUM_GAP_M_S
from synth.solver.told_lines import SQUARED_ERROR_ALONE, from_the_middle, told_factors
from synth.solver.tuned_lines import LOOSE_M_S

NEGLIGIBLE_MASS = 1e-8
"""For a polish. The cost is that with 1e-12 within 3e-5 of itself, a thirtieth of what ends a polish, in two thirds of
the time; in five cases of the default book a polish took as many steps, and ended at the same cost within 1e-4."""

GAP_NODES = 13
"""Places of the path at which the gap is held open while coefficients move."""


@frozen_arrays
class Terms:
    """What coefficients are multiplied by at all path nodes and modes of a chain: `of_stage` (N, modes of it, T)."""

    stage: Ints
    lines: Ints
    of_stage: tuple[Floats, ...]

    def slopes(self, by_lines: Floats) -> Floats:
        """Derivatives by the coefficients of every line (·, T) of those by line values (2, N, M)."""
        each = [(by_lines[side][:, self.stage == k], self.of_stage[k]) for k, side in self.lines]
        return np.array([np.einsum("nm,nmt->t", values, terms) for values, terms in each])

    def bends(self, by_lines: Floats) -> Floats:
        """Second derivatives (·, T, T) of those by each line value alone (2, N, M)."""
        each = [(by_lines[side][:, self.stage == k], self.of_stage[k]) for k, side in self.lines]
        return np.array([np.einsum("nmt,nm,nmu->tu", terms, values, terms) for values, terms in each])


@frozen_arrays
class Coordinates:
    """Coefficients of all lines as a point in which the Hessian at `start` is about the unit matrix times the cost."""

    start: PolynomialSurfaces
    scale: Floats

    def surfaces(self, y: Floats) -> PolynomialSurfaces:
        """The surfaces at a point."""
        coefficients, at = np.array(self.start.coefficients), tuple(self.start.lines.T)
        coefficients[at] += np.einsum("lab,lb->la", self.scale, y.reshape(len(self.scale), -1))
        return replace(self.start, coefficients=coefficients)

    def slopes(self, by_coefficient: Floats) -> Floats:
        """Derivatives by the point of those by the coefficients of every line (·, T)."""
        found: Floats = np.einsum("lab,la->lb", self.scale, by_coefficient).ravel()
        return found


@one_blas_thread()
def polish_surfaces(
    start: PolynomialSurfaces,
    evaluation: SurfaceEvaluation,
    aim: Aim,
    max_iterations: int = 60,
    tolerance: float = 1e-3,
) -> Descent[PolynomialSurfaces]:
    """Minimise the cost over all coefficients, keeping V_hi − V_lo ≥ `MINIMUM_GAP_M_S` at all pressures.

    It ends when a step changes the cost by less than `tolerance` of the first cost without the price of time. The
    result costs no more than the start, with its gaps opened. Raises `CoarseGridError` if that cost is not positive.
    """
    modes, nodes_m = evaluation.chain.modes, evaluation.chain.grid.path_m[:-1]
    start = opened(start)
    of_stage = (start.terms(nodes_m, k, modes.pressure_kpa[modes.stage == k]) for k in range(modes.stages))
    terms = Terms(modes.stage, start.lines, tuple(of_stage))

    def at(surfaces: PolynomialSurfaces) -> SurfaceCost:
        return evaluation.gradient(surfaces.at(nodes_m, modes), aim)

    first = at(start)
    require_positive(first.cost_m2_s2, "surfaces", OWN_GRID, keys=())
    coordinates = Coordinates(start, whitening(terms, first))
    if aim.prices_time:
        timeless = evaluation.gradient(start.at(nodes_m, modes), aim.timeless)
        tolerance *= timeless.cost_m2_s2 / first.cost_m2_s2

    def by_point(cost: SurfaceCost) -> CostAndSlopes:
        return cost.cost_m2_s2, coordinates.slopes(terms.slopes(cost.slopes))

    found = descend(
        lambda y: by_point(at(coordinates.surfaces(y))), by_point(first), gaps_open(coordinates),
        max_iterations, tolerance,
        allowed=lambda y: least_gap(coordinates.surfaces(y)).min() >= 0.5 * MINIMUM_GAP_M_S,
    )  # fmt: skip
    best = coordinates.surfaces(found.best)
    surfaces, cost = opened(best), found.cost_after
    if surfaces is not best:
        cost = at(surfaces).cost_m2_s2
    if not 0.0 < cost <= first.cost_m2_s2:
        surfaces, cost = start, first.cost_m2_s2
    return found.ending(surfaces, cost)


def whitening(terms: Terms, first: SurfaceCost) -> Floats:
    """Of each line the matrix (·, T, T) of `whitening`, with the exact second derivatives by each line value."""
    bends = terms.bends(np.maximum(first.bends, 0.0) / first.cost_m2_s2)
    squares = terms.bends(np.ones_like(first.bends))
    loose = squares / (squares[:, :1, :1] * LOOSE_M_S**2)
    lower = np.linalg.cholesky(bends + loose)
    found: Floats = np.linalg.inv(lower).transpose(0, 2, 1)
    return found


def opened(surfaces: PolynomialSurfaces) -> PolynomialSurfaces:
    """Every pair moved apart until its gap is at least the minimum; the same object where none need be."""
    short = np.maximum(MINIMUM_GAP_M_S - least_gap(surfaces), 0.0)
    return moved_apart(surfaces, short) if short.any() else surfaces


def least_gap(surfaces: PolynomialSurfaces) -> Floats:
    """Smallest V_hi − V_lo of every stage over a fine path mesh and all pressures, (K + 1,); inf without a pair.

    A gap that is linear in the pressure is smallest at the lowest or at the highest.
    """
    nodes_m = np.linspace(surfaces.start_m, surfaces.exit_m, 201)
    found = np.full(len(surfaces.stage_kpa), np.inf)
    for k in np.flatnonzero(surfaces.has_line.all(axis=1)):
        gap = (
            surfaces.terms(nodes_m, int(k), surfaces.stage_kpa[[0, -1]]) @ np.diff(surfaces.coefficients[k], axis=0)[0]
        )
        found[k] = gap.min()
    return found


def gaps_open(coordinates: Coordinates) -> list[Any]:
    """Linear constraints V_hi − V_lo ≥ gap at points along the path and both ends of the pressure, for each pair."""
    from scipy.optimize import LinearConstraint  # start-up: scipy only where it is needed

    start, scale = coordinates.start, coordinates.scale
    number = {(int(k), int(side)): i for i, (k, side) in enumerate(start.lines)}
    nodes_m = np.linspace(start.start_m, start.exit_m, GAP_NODES)
    found = []
    for k in np.flatnonzero(start.has_line.all(axis=1)).tolist():
        terms = start.terms(nodes_m, k, start.stage_kpa[[0, -1]]).reshape(-1, scale.shape[2])
        rows = np.zeros((len(terms), *scale.shape[:2]))
        rows[:, number[k, 0]], rows[:, number[k, 1]] = -terms @ scale[number[k, 0]], terms @ scale[number[k, 1]]
        least = MINIMUM_GAP_M_S - terms @ np.diff(start.coefficients[k], axis=0)[0]
        found.append(LinearConstraint(rows.reshape(len(rows), -1), least, np.inf))
    return found


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
