"""Lines whose cost on the grid of their design is what an independent computation says it is.

A polish goes wherever the expected cost of its own grid is least, into the errors of that grid too. So its end is
judged twice: on the grid of the design, and without it. Where the two do not agree, the design is done again on a finer
grid, once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final, Generic, Protocol, TypeVar

from plant_models.frozen_arrays import frozen_arrays
from synth.problem.requirement import FrictionRange, OverspeedLimit
from synth.problem.requirement_found import Finding
from synth.retarder.tuned_case import GridCheck
from synth.solver.backward_induction import Solution, solve_all
from synth.solver.chain.chain import Chain
from synth.solver.chain.scenarios import persistent_scenarios
from synth.solver.chance_constraint import keep_overspeed_limit
from synth.solver.coarse_grid import CoarseGridError
from synth.solver.descent import Descent
from synth.solver.finer_speed import finer_in_speed
from synth.solver.policy_density import exit_density
from synth.solver.polynomial_fit import Fit
from synth.solver.polynomial_lines import PolynomialLines
from synth.solver.tuned_lines import fitted, polished
from synth.solver.worst_case import guard_worst_case


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
