"""Lines for a regulator that is told the friction of every cut: those of a table, polished anew for each friction.

The polish goes from one friction to the next, from the middle outward: what is best at one is a good beginning at the
next, so that one step of the polish mostly suffices. Between the frictions lines are interpolated.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from plant_models import Plant
from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.problem.criterion import Criterion
from synth.problem.problem import Aim
from synth.solver.chain.chain import Chain, known_factors
from synth.solver.chain.scenarios import equally_spaced_normal
from synth.solver.descent import CoarseGridError
from synth.solver.evaluation import Evaluation, scenario_densities
from synth.solver.switching_lines import PolynomialLines
from synth.solver.tuned_lines import polish

SQUARED_ERROR_ALONE = Criterion(stall_cost_m2_s2=0.0, switching_tolerance_m2_s2=0.0, time_price_m2_s3=0.0)
"""What is measured: neither stalls nor switchings nor time cost anything besides."""


@dataclass(frozen=True)
class Effort:
    """How well lines are polished for each friction.

    `frictions`: how many values of ξ_cut, equally spaced from −4 to 4 standard deviations; `degree` of the lines, at
    least; `iterations` of the polish at the mean friction, and at each of the others, until a step changes the cost by
    less than `tolerance` of it; `resistance_nodes`: values of the running resistance, which is not told. A friction
    that makes less than `least_share` of the mean square error is not worth a polish.
    """

    frictions: int = 9
    degree: int = 6
    iterations: tuple[int, int] = (3, 1)
    tolerance: float = 1e-4
    resistance_nodes: int = 1
    least_share: float = 0.02


IN_A_TUNE = Effort()


@frozen_arrays
class ToldLines:
    """`lines`[i] for cuts whose ξ_cut is `factor`[i], (M,), ascending."""

    factor: Floats
    lines: tuple[PolynomialLines, ...]

    def at(self, factor: float) -> PolynomialLines:
        """Lines for the friction factor `factor`: linear between the neighbours, beyond the ends those of the end.

        Two pairs of lines that keep their distance are joined by pairs that keep it.
        """
        after = int(np.clip(np.searchsorted(self.factor, factor), 1, max(len(self.factor) - 1, 1)))
        if len(self.factor) == 1 or factor >= self.factor[-1]:
            return self.lines[-1]
        low, high = self.factor[after - 1 : after + 1]
        part = max((factor - low) / (high - low), 0.0)
        before, behind = (self.lines[i].coefficients for i in (after - 1, after))
        return replace(self.lines[0], coefficients=(1.0 - part) * before + part * behind)


def told_lines(
    design: Chain, target_m_s: float, common: PolynomialLines, curvature: Floats, effort: Effort = IN_A_TUNE
) -> ToldLines:
    """Lines of small mean square error at each of several frictions, on the grid of `design`.

    `common`: lines that serve all frictions, to begin with; `curvature` as `fit_lines` has it. At each of the frictions
    the mean square error on `design` is no larger than that of `common`.
    """
    factor, weight = told_factors(design.plant, effort.frictions)
    start = of_degree(common, max(effort.degree, common.degree))
    evaluations = [knowing(design, target_m_s, float(each), effort.resistance_nodes) for each in factor]
    squares = mean_squares(design, target_m_s, start, factor, effort.resistance_nodes)
    worth = weight * squares >= effort.least_share * float(weight @ squares)
    found: dict[int, PolynomialLines] = {}
    for i in from_the_middle(len(factor)):
        neighbours = [found[j] for j in (i - 1, i + 1) if j in found]
        begins, most = (*neighbours, start), float(squares[i])
        iterations = effort.iterations[1 if neighbours else 0]
        if worth[i]:
            found[i] = improved(evaluations[i], begins, curvature, most, iterations, effort.tolerance)
        else:
            found[i] = next((each for each in begins if 0.0 < mean_square(evaluations[i], each) <= most), start)
    return ToldLines(factor, tuple(found[i] for i in range(len(factor))))


def improved(
    evaluation: Evaluation, begins: Sequence[PolynomialLines], curvature: Floats, most: float,
    iterations: int, tolerance: float,
) -> PolynomialLines:  # fmt: skip
    """The end of the first polish, from one of `begins` after the other, that costs `most` at most; else the last.

    A beginning whose cost comes out negative, because the grid is too coarse for it, is left out.
    """
    nodes_m = evaluation.chain.grid.path_m
    for begin in begins:
        try:
            end = polish(begin, curvature, nodes_m, evaluation.gradient, iterations, tolerance)
        except CoarseGridError:
            continue
        if end.cost_after <= most:
            return end.best
    return begins[-1]


def told_factors(plant: Plant, count: int) -> tuple[Floats, Floats]:
    """Friction factors from −4 to 4 standard deviations, ascending, and how often they are met.

    Those at the floor are one.
    """
    z, weight = equally_spaced_normal(count)
    factor, place = np.unique(plant.friction.cut_factor(z, plant.friction_cv), return_inverse=True)
    return factor, np.bincount(place, weight).astype(np.float64)


def knowing(design: Chain, target_m_s: float, factor: float, resistance_nodes: int) -> Evaluation:
    """Exact figures of lines at one known friction."""
    scenarios = known_factors(design.plant, np.array([factor]), resistance_nodes)
    return Evaluation(replace(design, scenarios=scenarios), Aim(target_m_s, SQUARED_ERROR_ALONE))


def mean_squares(
    design: Chain, target_m_s: float, lines: PolynomialLines, factor: Floats, resistance_nodes: int
) -> Floats:
    """`mean_square` of the same lines at every known friction `factor` (M,), from one recursion."""
    together = replace(design, scenarios=known_factors(design.plant, factor, resistance_nodes))
    densities = scenario_densities(together, lines.at(design.grid.path_m))
    squares = np.array([each.rms_m_s(target_m_s) ** 2 for each in densities]).reshape(len(factor), -1)
    share = together.scenarios.weight.reshape(len(factor), -1) * len(factor)
    found: Floats = (share * squares).sum(axis=1)
    return found


def mean_square(evaluation: Evaluation, lines: PolynomialLines) -> float:
    """Expected squared error at the exit; 0 where it comes out negative."""
    return evaluation.rms_m_s(lines.at(evaluation.chain.grid.path_m)) ** 2


def of_degree(lines: PolynomialLines, degree: int) -> PolynomialLines:
    """The same lines, written with a degree no smaller than theirs."""
    return replace(lines, coefficients=np.pad(lines.coefficients, [(0, 0), (0, 0), (0, degree - lines.degree)]))


def from_the_middle(count: int) -> Iterator[int]:
    """All numbers below `count`, each beside one that came before it."""
    middle = count // 2
    yield middle
    yield from range(middle - 1, -1, -1)
    yield from range(middle + 1, count)
