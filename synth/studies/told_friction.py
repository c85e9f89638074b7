"""What could be reached if the regulator were told the friction of every cut: the practical reference for regret.

For each of several known friction factors lines are designed from several beginnings, polished until nothing is gained,
and the best are kept: a polish that ends early, or in a poor corner, would flatter everything that is compared with it.
All else is as it is: sensor, sampling, valves, path noise, one stage a command, lines of the same degree. It is no
lower bound: whoever measures the speed better than the sensor can do better.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models import PlantError
from plant_models.frozen_arrays import frozen_arrays
from synth.book.comparison.friction_bound import interleaved
from synth.problem.aim import Aim
from synth.simulation.closed_loop import ClosedLoop, LineController
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import Chain, with_known_friction
from synth.solver.evaluation import Evaluation
from synth.solver.polish import Polish, polish
from synth.solver.polynomial_fit import Fit
from synth.solver.polynomial_lines import PolynomialLines
from synth.solver.tuned_lines import fitted

LINE_NODES = 301


@dataclass(frozen=True)
class Effort:
    """Of each polish; begun anew from its own end in further `rounds`, it forgets a bad Hessian."""

    iterations: int = 100
    tolerance: float = 1e-4
    rounds: int = 2


TO_THE_END = Effort()


@frozen_arrays
@dataclass(frozen=True, eq=False)
class ToldFriction:
    """Lines for known factors (I,) that occur with probability `weight` (I,).

    They are designed for the mean running resistance (`with_known_friction`), so only passes tell what they reach.
    """

    factor: NDArray[np.float64]
    weight: NDArray[np.float64]
    lines: tuple[PolynomialLines, ...]

    def sample(self, loop: ClosedLoop, passes: RandomPasses) -> ExitSample:
        """Closed loop of cuts whose friction is told: pass j has the factor j modulo I, and the weight of that factor.

        Passes that make no whole round of the factors are left out.
        """
        count = len(self.factor)
        whole = passes.part(0, len(passes) - len(passes) % count)
        strata = []
        for i, (factor, lines) in enumerate(zip(self.factor, self.lines, strict=True)):
            strata.append(
                loop.run(
                    LineController(lines.at(lines.nodes_m(LINE_NODES))),
                    loop.draws(whole.every(count, i), float(factor)),
                )
            )
        return interleaved(strata, self.weight)


def told_friction(design: Chain, aim: Aim, degree: int, nodes: int, effort: Effort = TO_THE_END) -> ToldFriction:
    """Lines for each of `nodes` Gauss–Hermite factors of ξ_cut, and for the friction unknown as one more beginning."""
    plant = design.plant
    z, weight = np.polynomial.hermite_e.hermegauss(nodes)
    factors = plant.friction.cut_factor(z, plant.friction_cv)
    unknown = fitted(solve(design, aim), degree)
    common = best_polished(Evaluation(design, aim), [(unknown.lines, unknown)], effort)
    best = []
    for factor in factors:
        known = with_known_friction(design, float(factor))
        own = fitted(solve(known, aim), degree)
        begins = [(own.lines, own), (common, own), (common, unknown)]
        best.append(best_polished(Evaluation(known, aim), begins, effort))
    return ToldFriction(factors, weight / weight.sum(), tuple(best))


def best_polished(
    evaluation: Evaluation, begins: list[tuple[PolynomialLines, Fit]], effort: Effort = TO_THE_END
) -> PolynomialLines:
    """The best end of polishes from several lines, each in the coordinates of a fit.

    A beginning whose cost comes out negative on this grid is left out; `PlantError` if none is left.
    """
    evaluate, nodes = evaluation.gradient, evaluation.chain.grid.path_m

    def ends() -> Iterator[Polish]:
        for lines, fit in begins:
            try:
                found = polish(lines, fit.curvature, nodes, evaluate, effort.iterations, effort.tolerance)
                for _ in range(effort.rounds - 1):
                    found = polish(found.lines, fit.curvature, nodes, evaluate, effort.iterations, effort.tolerance)
            except PlantError:
                continue
            yield found

    best = min(ends(), key=lambda end: end.cost_after, default=None)
    if best is None:
        raise PlantError("grid: speed_step_m_s or path_step_m is too coarse for this plant: make both smaller")
    return best.lines
