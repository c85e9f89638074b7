"""Exit error against the degree of the polynomial lines (R4): every cut class and target, degrees 1 to 6, rounded
and predicted as an exported table is.

For each degree the lines are fitted, polished and rounded to a table, as a tune does; the rms is predicted on the grid
on which exported tables are predicted, and simulated on the same passes for every degree.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from plant_models import Plant
from scripts.studies.cases import CREATED, from_the_entrance, of_masses, side_by_side
from scripts.studies.near_target import NEAR_M_S
from scripts.studies.study import Findings, MarkdownTable, Method, Tell, option, plus_minus, table
from synth.problem.problem import Aim
from synth.problem.resolution import finer_for_check
from synth.retarder.class_setup import Origin
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.tuned_table import predict
from synth.simulation.closed_loop import Controller, LineController, TableController, simulate_many
from synth.simulation.replicates import Interval, rms_of, rms_quotient, share_of
from synth.solver.backward_induction import Solution, solve_all
from synth.solver.chain.chain import Chain, check_chain, persistent_chain
from synth.solver.evaluation import density_and_occupancy
from synth.solver.resolved_density import resolved_density
from synth.solver.switching_lines import PolynomialLines
from synth.solver.tabulate import UNPREDICTED, tabulate
from synth.solver.tuned_lines import fit_lines, polished
from tuning_tables import ControllerTable, Generator, InvalidTable


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


COMPARED = 3
"""Degree that the others are set against: that of the default."""

SOLVER_LINES = 0
"""Stands for the solver's own lines where a degree is told."""


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    masses_t: tuple[float, ...] = option((), "only cuts of these masses, t")
    targets_m_s: tuple[float, ...] = option((), "exit speeds, m/s; those of the configuration without it", (0.1, 20.0))
    degrees: tuple[int, ...] = option((1, 2, 3, 4, 5, 6), f"{COMPARED}, and others set against it", (1, 9))
    passes: int = option(100_000, "stratified passes of each table", (200, 10**8))


@dataclass(frozen=True)
class Row:
    """Tables of one degree, or the solver's own lines (degree 0).

    `near_...`: of the passes that end near the target by this table and by that of degree `COMPARED`; `near_ratio`:
    rms / rms of that degree. `fitted_predicted_rms_m_s`: before the polish; None where that makes no table, and of the
    solver's own lines.
    """

    degree: int
    fitted_predicted_rms_m_s: float | None
    predicted_rms_m_s: float
    rms_m_s: float
    rms_ci95_m_s: Interval
    outside: float
    near_ratio: float
    near_ratio_ci95: Interval


@dataclass(frozen=True)
class CaseRow:
    """One case by degree; a degree that makes no table is left out."""

    case: str
    rows: tuple[Row, ...]


@dataclass(frozen=True)
class Degrees(Findings):
    """All cases."""

    config_sha256: str
    seed: int
    passes: int
    degrees: tuple[int, ...]
    cases: tuple[CaseRow, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`rms`, `ratio`: a row a case, a column a degree; `polish`: what the polish is worth."""
        heads = ("case", *(f"degree {degree}" for degree in self.degrees), "solver's lines")
        return {
            "rms": table("rms, mm/s: predicted / simulated ± half its 95 % interval", heads,
                         (self.line(case, rms_cell) for case in self.cases)),
            "ratio": table(f"rms / rms of degree {COMPARED}, cuts within {NEAR_M_S:g} m/s of the target; ± half the "
                           "95 % interval", heads, (self.line(case, ratio_cell) for case in self.cases)),
            "polish": table("predicted rms of the fitted lines / of the polished ones", heads[:-1],
                            (self.line(case, polish_cell)[:-1] for case in self.cases)),
        }  # fmt: skip

    def line(self, case: CaseRow, cell: Callable[[Row], str]) -> tuple[str, ...]:
        """The cells of one case."""
        by_degree = {row.degree: row for row in case.rows}
        columns = (*self.degrees, SOLVER_LINES)
        return (case.case, *(cell(by_degree[degree]) if degree in by_degree else "no table" for degree in columns))

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated, and predicted / simulated over all tables."""
        ratios: dict[int, list[float]] = {r.degree: [] for case in self.cases for r in case.rows}
        for row in (row for case in self.cases for row in case.rows):
            ratios[row.degree].append(row.predicted_rms_m_s / row.rms_m_s)
        every = [ratio for degree, found in ratios.items() if degree for ratio in found]
        cubic = ratios[COMPARED]
        return (
            f"{self.passes} stratified passes of seed {self.seed}, the same in every cell",
            f"predicted / simulated: {min(every):.3f} to {max(every):.3f} over {len(every)} tables, "
            f"{min(cubic):.3f} to {max(cubic):.3f} over the {len(cubic)} of degree {COMPARED}",
        )


def rms_cell(row: Row) -> str:
    """'41.4 / 41.50 ± 0.28'."""
    return f"{1e3 * row.predicted_rms_m_s:.1f} / {plus_minus(row.rms_m_s, row.rms_ci95_m_s, 2, 1e3)}"


def ratio_cell(row: Row) -> str:
    """'1.063 ± 0.007'."""
    return "1" if row.degree == COMPARED else plus_minus(row.near_ratio, row.near_ratio_ci95, 3)


def polish_cell(row: Row) -> str:
    """'1.18'."""
    fitted = row.fitted_predicted_rms_m_s
    return "no table" if fitted is None else f"{fitted / row.predicted_rms_m_s:.2f}"


def run(options: Options, tell: Tell) -> Degrees:
    """Tables of every degree for every case."""
    config = from_the_entrance(options.config)
    degrees = tuple(sorted({*options.degrees, COMPARED}))

    def rows_of(item: tuple[str, Plant]) -> list[CaseRow]:
        label, plant = item
        check = check_chain(plant, finer_for_check(config.resolution))
        design = persistent_chain(plant, config.resolution)
        aims = [Aim(target, config.criterion) for target in options.targets_m_s or config.targets_of(label)]
        rows = []
        for solution in solve_all(design, aims):
            tables = tuple(tables_by_degree(solution, check, degrees, origin(config)))
            predicted = rms_of_solver_lines(solution, check)
            rows.append(case_row(solution, tables, predicted, config.validation.seed, options.passes))
            tell(f"{rows[-1].case}: {len(degrees)} degrees")
        return rows

    found = side_by_side(rows_of, of_masses(config, options.masses_t).plants())
    every = tuple(row for rows in found for row in rows)
    return Degrees(config.sha256, config.validation.seed, options.passes, degrees, every)


def origin(config: ResolvedConfig) -> Origin:
    """Who makes the tables."""
    return Origin(Generator("retarder-synth study", "0", config.sha256), CREATED)


def case_row(
    solution: Solution, tables: tuple[TableOfDegree, ...], lines_rms_m_s: float, seed: int, passes: int
) -> CaseRow:
    """Figures of every polished table, and of the solver's lines, of which an rms of `lines_rms_m_s` is predicted,
    last; all on the same passes."""
    plant, target = solution.chain.plant, solution.aim.target_speed_m_s
    laws: dict[int, Controller] = {each.degree: TableController(each.table) for each in tables}
    laws[SOLVER_LINES] = LineController(solution.lines, farthest=solution.chain.decisions.swept)
    samples = {degree: simulate_many(plant, law, seed, passes) for degree, law in laws.items()}
    weight = samples[SOLVER_LINES].weight
    errors = {degree: each.exit_speed_m_s - target for degree, each in samples.items()}
    fitted = {each.degree: each.fitted_rms_m_s for each in tables}
    predicted = {**{each.degree: each.rms_m_s for each in tables}, SOLVER_LINES: lines_rms_m_s}
    rows = []
    for degree, error in errors.items():
        rms, rms_ci95 = rms_of(error, weight)
        both = np.where((np.abs(error) <= NEAR_M_S) & (np.abs(errors[COMPARED]) <= NEAR_M_S), weight, 0.0)
        ratio, ratio_ci95 = rms_quotient(error, errors[COMPARED], both)
        rows.append(
            Row(
                degree, fitted.get(degree), predicted[degree], rms, rms_ci95,
                share_of(np.abs(error) > NEAR_M_S, weight)[0], ratio, ratio_ci95,
            )
        )  # fmt: skip
    return CaseRow(f"{plant.cut.mass_t:g} t to {target:g} m/s", tuple(rows))


METHOD = Method(Options, Options(None, (52.0,), (3.0,), (1, 3), 200), Degrees, run)
