"""Which degree the lines need: tables of every degree, rounded and predicted as the exported one is."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from synth.book.case_result import DegreeStudy
from synth.book.class_setup import Origin
from synth.book.rounded_table import predict
from synth.solver.backward_induction import Solution
from synth.solver.chain.chain import Chain
from synth.solver.policy_density import density_and_occupancy
from synth.solver.polynomial_fit import fit_lines
from synth.solver.polynomial_lines import PolynomialLines
from synth.solver.resolved_density import resolved_density
from synth.solver.tabulate import UNPREDICTED, tabulate
from synth.solver.tuned_lines import polished
from tuning_tables import ControllerTable, InvalidTable


@dataclass(frozen=True)
class TablesOfDegree:
    """Tables of lines of one degree, fitted and polished; None where rounding would let two lines touch."""

    degree: int
    fitted: ControllerTable | None
    polished: ControllerTable | None


def tables_by_degree(solution: Solution, degrees: tuple[int, ...], origin: Origin) -> Iterator[TablesOfDegree]:
    """Lines of every degree, fitted and polished as a tune does for a criterion without a requirement."""
    target_m_s, plant = solution.aim.target_speed_m_s, solution.chain.plant
    _, occupancy = density_and_occupancy(solution.chain, solution.lines)

    def table(lines: PolynomialLines) -> ControllerTable | None:
        stamp = (origin.generator, f"degree-{lines.degree}", origin.created)
        try:
            return tabulate(plant, lines, target_m_s, UNPREDICTED, *stamp)
        except InvalidTable:
            return None

    for degree in degrees:
        fit = fit_lines(solution, occupancy.samples, degree)
        yield TablesOfDegree(degree, table(fit.lines), table(polished(solution, fit).lines))


def degree_study(solution: Solution, check: Chain, label: str, tables: tuple[TablesOfDegree, ...]) -> DegreeStudy:
    """Rms that the forward density on `check` gives each of `tables`, and the solver's lines; NaN without a table."""
    target = solution.aim.target_speed_m_s

    def rms_m_s(table: ControllerTable | None) -> float:
        return math.nan if table is None else predict(check, table).rms_m_s(target)

    return DegreeStudy(
        label=f"{label}, {target:g} m/s",
        degrees=tuple(each.degree for each in tables),
        fitted_rms_m_s=np.array([rms_m_s(each.fitted) for each in tables]),
        polished_rms_m_s=np.array([rms_m_s(each.polished) for each in tables]),
        lines_rms_m_s=resolved_density(check, solution.lines.at(check.grid.path_m), target).rms_m_s(target),
    )
