"""Lines whose cost on the grid of their design is what a finer grid says it is.

A polish goes wherever the expected cost of its own grid is least, into the errors of that grid too. So its end is
evaluated twice: on the grid of the design, and on the finer one of the prediction. Where the two do not agree, the
design is done again on a finer grid, once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from plant_models.frozen_arrays import frozen_arrays
from synth.book.grid_check import GridCheck
from synth.book.rounded_table import with_prediction
from synth.solver.backward_induction import Solution, solve_all
from synth.solver.chain.chain import Chain
from synth.solver.chain.scenarios import persistent_scenarios
from synth.solver.coarse_grid import CoarseGridError
from synth.solver.exit_density import ExitDensity
from synth.solver.finer_speed import finer_in_speed
from synth.solver.policy_density import exit_density
from synth.solver.polynomial_fit import Fit
from synth.solver.polynomial_lines import PolynomialLines
from synth.solver.required_lines import RequiredLines, required_lines
from synth.solver.tuned_lines import fitted
from tuning_tables import ControllerTable

FINER_SPEED: Final = 2.0
FINER_FRICTIONS, FINER_RESISTANCES = 9, 5
"""The second design: speed steps divided by the first, so many Gauss nodes of ξ_cut and of w."""

NODES_KEPT: Final = 1
"""Path nodes at which a solution keeps its values: the entrance. Nothing after the solve reads more."""

Rounding = Callable[[PolynomialLines], ControllerTable]
"""Lines → the table of them as a controller holds it, not yet predicted."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class CheckedDesign:
    """Polished lines for one aim, and the table of them for the measured speed, decided at rest, with its prediction.

    `kept`: how the lines were found from `fit`; `predicted`: the exit density on the finer grid; `grid`: what the grid
    of the design says of the lines beside it.
    """

    fit: Fit
    kept: RequiredLines
    table: ControllerTable
    predicted: ExitDensity
    grid: GridCheck


def checked_design(solution: Solution, check: Chain, degree: int, rounding: Rounding) -> CheckedDesign:
    """The lines of `solution`; where the grid of its chain is not believed, these or a second design's.

    Of the two those with the lesser rms predicted on `check`; of the second where the first grid is too coarse for
    lines. Raises `PlantError` where that is too coarse as well, `InvalidTable` where rounding would let lines touch.
    """
    try:
        designs = [design_of(solution, check, degree, rounding, again=False)]
    except CoarseGridError:
        designs = []
    if not designs or not designs[0].grid.is_believed:
        (second,) = solve_all(finer(solution.chain), [solution.aim], nodes_kept=NODES_KEPT)
        designs.append(design_of(second, check, degree, rounding, again=True))
    return min(designs, key=lambda each: each.table.predicted.rms_m_s)


def design_of(solution: Solution, check: Chain, degree: int, rounding: Rounding, again: bool) -> CheckedDesign:
    """Lines fitted to a solution, polished, rounded, and predicted on both grids."""
    chain, target_m_s, fit = solution.chain, solution.aim.target_speed_m_s, fitted(solution, degree)
    kept = required_lines(solution, check, fit)
    table, predicted = with_prediction(check, rounding(kept.lines))
    on_design = exit_density(chain, kept.lines.at(chain.grid.path_m))
    grid = GridCheck(on_design.rms_m_s(target_m_s), table.predicted.rms_m_s, again)
    return CheckedDesign(fit, kept, table, predicted, grid)


def finer(design: Chain) -> Chain:
    """The chain of a second design: the same path nodes, finer speeds, more scenarios."""
    scenarios = persistent_scenarios(design.plant, FINER_FRICTIONS, FINER_RESISTANCES)
    return finer_in_speed(design, FINER_SPEED, scenarios)
