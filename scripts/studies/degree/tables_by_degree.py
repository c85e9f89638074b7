"""Tables of lines of every degree for one solution, rounded and predicted as an exported one is."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from plant_models import Plant
from synth.retarder.class_setup import Origin
from synth.retarder.rounded_table import predict
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
class TableOfDegree:
    """The table of the polished lines of one degree, and the rms in m/s that the forward density predicts of it.

    `fitted_rms_m_s`: of the table of the lines before the polish; None where rounding would let two lines touch.
    """

    degree: int
    table: ControllerTable
    rms_m_s: float
    fitted_rms_m_s: float | None


def tables_by_degree(
    solution: Solution, check: Chain, degrees: tuple[int, ...], origin: Origin
) -> Iterator[TableOfDegree]:
    """Lines of every degree, polished as a tune does for a criterion without a requirement, predicted on `check`.

    A degree whose polished lines would touch when rounded is left out.
    """
    _, occupancy = density_and_occupancy(solution.chain, solution.lines)
    target_m_s, plant = solution.aim.target_speed_m_s, solution.chain.plant
    for degree in degrees:
        fit = fit_lines(solution, occupancy.samples, degree)
        table = table_of(plant, polished(solution, fit).best, target_m_s, origin)
        before = table_of(plant, fit.lines, target_m_s, origin)
        if table is not None:
            rms = predict(check, table).rms_m_s(target_m_s)
            fitted = None if before is None else predict(check, before).rms_m_s(target_m_s)
            yield TableOfDegree(degree, table, rms, fitted)


def table_of(plant: Plant, lines: PolynomialLines, target_m_s: float, origin: Origin) -> ControllerTable | None:
    """The rounded table; None where two lines would touch."""
    try:
        return tabulate(
            plant, lines, target_m_s, UNPREDICTED, origin.generator, f"degree-{lines.degree}", origin.created
        )
    except InvalidTable:
        return None


def rms_of_solver_lines(solution: Solution, check: Chain) -> float:
    """Rms in m/s that the forward density on `check` predicts of the solver's own lines, asked as they were swept."""
    target_m_s = solution.aim.target_speed_m_s
    as_swept = replace(check, decisions=replace(check.decisions, farthest=check.decisions.swept))
    return resolved_density(as_swept, solution.lines.at(check.grid.path_m), target_m_s).rms_m_s(target_m_s)
