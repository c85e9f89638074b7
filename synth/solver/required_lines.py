"""The lines of one aim after everything that its criterion asks for."""

from __future__ import annotations

from dataclasses import dataclass

from synth.problem.requirement import FrictionRange, OverspeedLimit
from synth.problem.requirement_found import Finding
from synth.solver.backward_induction import Solution
from synth.solver.chain.chain import Chain
from synth.solver.chance_constraint import keep_overspeed_limit
from synth.solver.descent import Descent
from synth.solver.polynomial_fit import Fit
from synth.solver.polynomial_lines import PolynomialLines
from synth.solver.tuned_lines import polished
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
