"""Lines whose cost on the grid of their design is what an independent computation says it is, and surfaces of a case
for commands at any time, polished from its lines for commands at rest.

A polish goes wherever the expected cost of its own grid is least, into the errors of that grid too. So its end is
judged twice: on the grid of the design, and without it. Where the two do not agree, the design is done again on a finer
grid, once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final, Generic, Protocol, TypeVar

import numpy as np

from plant_models import Plant
from plant_models.frozen_arrays import frozen_arrays
from synth.problem.problem import Aim
from synth.problem.requirement import Finding, FrictionRange, OverspeedLimit
from synth.problem.resolution import Resolution, design_resolution
from synth.retarder.tuned_case import GridCheck
from synth.solver.any_time.polynomial_surfaces import CUBIC_AND_SLOPE, PolynomialSurfaces, surfaces_of_lines
from synth.solver.any_time.sampled_chain import EstimateError, check_sampled_chain, sampled_chain
from synth.solver.any_time.surface_evaluation import SurfaceEvaluation
from synth.solver.any_time.surface_polish import NEGLIGIBLE_MASS, polish_surfaces
from synth.solver.backward_induction import Solution, solve_all
from synth.solver.chain.chain import Chain, finer_in_speed
from synth.solver.chain.scenarios import persistent_scenarios
from synth.solver.descent import CoarseGridError, Descent
from synth.solver.evaluation import exit_density
from synth.solver.exit_density import ExitDensity, without_negative
from synth.solver.kept_requirement import guard_worst_case, keep_overspeed_limit
from synth.solver.switching_lines import PolynomialLines
from synth.solver.tabulate import UNPREDICTED, surfaces_of, tabulate
from synth.solver.tuned_lines import Fit, fitted, polished
from tuning_tables import ControllerTable, Estimator, Generator


@dataclass(frozen=True)
class RequiredLines:
    """`lines` to export; `polish`: how the lines of least cost were found; `finding`: what a requirement took."""

    lines: PolynomialLines
    polish: Descent[PolynomialLines]
    finding: Finding | None


def required_lines(solution: Solution, check: Chain, fit: Fit) -> RequiredLines:
    """Polish the fitted lines, then make them keep what the criterion requires, as predicted on `check`."""
    found = polished(solution, fit)
    finding: Finding | None
    match solution.aim.criterion.requirement:
        case OverspeedLimit() as limit:
            lines, finding = keep_overspeed_limit(solution, check, fit, found.best, limit)
        case FrictionRange() as friction:
            lines, finding = guard_worst_case(solution, check, fit, found.best, friction)
        case None:
            lines, finding = found.best, None
    return RequiredLines(lines, found, finding)


FINER_SPEED: Final = 2.0
FINER_FRICTIONS, FINER_RESISTANCES = 9, 5
"""The second design: speed steps divided by the first, so many Gauss nodes of ξ_cut and of w."""

NODES_KEPT: Final = 1
"""Path nodes at which a solution keeps its values: the entrance. Nothing after the solve reads more."""


class Judged(Protocol):
    """What an independent computation says of lines."""

    @property
    def rms_m_s(self) -> float:
        """Root mean square error at the exit."""

    @property
    def most_off(self) -> float:
        """Factor from this rms, either way, beyond which that of a design's grid is not believed."""


Verdict = TypeVar("Verdict", bound=Judged, covariant=True)

Judge = Callable[[PolynomialLines], Verdict]
"""Lines → what is computed of them without the grid of their design."""


@frozen_arrays
class CheckedDesign(Generic[Verdict]):
    """Polished lines for one aim, decided at rest.

    `kept`: how the lines were found from `fit`; `verdict`: what the judge said of them; `grid`: what the grid of the
    design says of the lines beside it.
    """

    fit: Fit
    kept: RequiredLines
    verdict: Verdict
    grid: GridCheck


def checked_design(solution: Solution, check: Chain, degree: int, judge: Judge[Verdict]) -> CheckedDesign[Verdict]:
    """The lines of `solution`; where the grid of its chain is not believed, these or a second design's.

    `check`: the chain on which a requirement of the criterion is kept. Of the two designs those with the lesser rms by
    `judge`; of the second where the first grid is too coarse for lines. Raises `PlantError` where that is too coarse as
    well, `InvalidTable` where rounding would let lines touch.
    """
    try:
        designs = [design_of(solution, check, degree, judge, again=False)]
    except CoarseGridError:
        designs = []
    if not designs or not designs[0].grid.is_believed:
        (second,) = solve_all(finer(solution.chain), [solution.aim], nodes_kept=NODES_KEPT)
        designs.append(design_of(second, check, degree, judge, again=True))
    return min(designs, key=lambda each: each.verdict.rms_m_s)


def design_of(
    solution: Solution, check: Chain, degree: int, judge: Judge[Verdict], again: bool
) -> CheckedDesign[Verdict]:
    """Lines fitted to a solution, polished, and judged with and without the grid."""
    chain, target_m_s, fit = solution.chain, solution.aim.target_speed_m_s, fitted(solution, degree)
    kept = required_lines(solution, check, fit)
    verdict = judge(kept.lines)
    on_design = exit_density(chain, kept.lines.at(chain.grid.path_m))
    grid = GridCheck(on_design.rms_m_s(target_m_s), verdict.rms_m_s, again, verdict.most_off)
    return CheckedDesign(fit, kept, verdict, grid)


def finer(design: Chain) -> Chain:
    """The chain of a second design: the same path nodes, finer speeds, more scenarios."""
    scenarios = persistent_scenarios(design.plant, FINER_FRICTIONS, FINER_RESISTANCES)
    days = ((share, finer_in_speed(day, FINER_SPEED, day.scenarios)) for share, day in design.other_days)
    return replace(finer_in_speed(design, FINER_SPEED, scenarios), other_days=tuple(days))


NOBODYS = Generator("none", "0", "0" * 64), "trial", "2000-01-01T00:00:00Z"
"""Origin of tables that are only tried."""


def surface_degrees(lines: PolynomialLines, has_gauge: bool) -> tuple[int, ...]:
    """Degrees in the path for the powers of the pressure: that of `lines`, and with a gauge one slope."""
    return (lines.degree, *CUBIC_AND_SLOPE[1:]) if has_gauge else (lines.degree,)


def starting_surfaces(plant: Plant, lines: PolynomialLines, has_gauge: bool) -> PolynomialSurfaces:
    """Lines for commands at rest, taken at every pressure."""
    stages = np.asarray(plant.position.stage_pressures_kpa[: plant.top_stage + 1])
    return surfaces_of_lines(lines, stages, surface_degrees(lines, has_gauge))


def polished_surfaces(
    plant: Plant, aim: Aim, start: PolynomialSurfaces, steps: Resolution, estimate: EstimateError | None = None
) -> Descent[PolynomialSurfaces]:
    """The surfaces of least cost near `start`, on the grid `steps`, for the measured or an estimated speed."""
    chain = replace(sampled_chain(plant, steps), estimate=estimate)
    return polish_surfaces(start, SurfaceEvaluation(chain, negligible_mass=NEGLIGIBLE_MASS), aim)


def surface_density(plant: Plant, table: ControllerTable) -> ExitDensity:
    """Exact exit-speed density of a table that decides at any time, by the measured speed."""
    check = check_sampled_chain(plant, design_resolution(plant, table.target_speed_m_s))
    lines = surfaces_of(table, check.grid.path_m[:-1], check.modes)
    return without_negative(SurfaceEvaluation(check).density(lines))


def trial_table(
    plant: Plant, surfaces: PolynomialSurfaces, target_m_s: float, estimator: Estimator | None = None
) -> ControllerTable:
    """The rounded table of surfaces that are only tried: of no origin, and not predicted."""
    return tabulate(plant, surfaces, target_m_s, UNPREDICTED, *NOBODYS, estimator)
