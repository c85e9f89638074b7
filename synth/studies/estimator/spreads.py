"""What the estimator gains at other spreads of friction, and at another position."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import median

from synth.configuration.config_file import load_config, parse_config
from synth.configuration.resolved_config import ResolvedConfig
from synth.problem.aim import Aim
from synth.problem.problem import Problem
from synth.simulation.stratified_passes import stratified_passes
from synth.studies.cases import Case, class_cases
from synth.studies.estimator.pair import FRESH, Compared, nominal, without_price
from synth.studies.markdown_table import MarkdownTable, around, table
from synth.studies.options import option
from synth.studies.side_by_side import side_by_side
from synth.studies.study import Findings, Method, Tell


@dataclass(frozen=True)
class Options:
    """What is studied."""

    retarder: str = option("rnz-2m-park", "position besides the default one")
    spreads: tuple[float, ...] = option((0.05, 0.15, 0.25), "CV of friction at the default position", (0.001, 1.0))
    masses_t: tuple[float, ...] = option((22.0, 52.0, 85.0), "only cuts of these masses, t")
    targets_m_s: tuple[float, ...] = option((), "exit speeds, m/s; those of the position without it", (0.1, 20.0))
    passes: int = option(20_000, "fresh passes of each case", (200, 10**7))


@dataclass(frozen=True)
class Row:
    """One case at one position and spread."""

    position: str
    cv: float
    case: str
    figures: Compared


@dataclass(frozen=True)
class Spreads(Findings):
    """All cases."""

    seed: int
    passes: int
    rows: tuple[Row, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`spreads`: a row a position and spread; `cases`: a row a case."""
        groups = dict.fromkeys((row.position, row.cv) for row in self.rows)
        by_group = [[row for row in self.rows if (row.position, row.cv) == group] for group in groups]
        each = ("position", "CV", "case", "without", "with estimator", "ratio [95 %]")
        heads = ("position", "CV", "cases", "least ratio", "median", "largest", "worse beyond the interval")
        return {
            "spreads": table("rms with / without estimator", heads, map(group_cells, by_group)),
            "cases": table("rms without and with estimator, m/s", each, map(case_cells, self.rows)),
        }

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        return (f"{self.passes} fresh stratified passes each, seed {self.seed}",)


def group_cells(rows: Sequence[Row]) -> tuple[str, ...]:
    """The cells of one position and spread."""
    ratios = [row.figures.ratio for row in rows]
    worse = sum(row.figures.ratio_ci95[0] > 1.0 for row in rows)
    found = (min(ratios), median(ratios), max(ratios))
    return (rows[0].position, f"{rows[0].cv:g}", f"{len(rows)}", *(f"{x:.2f}" for x in found), f"{worse}")


def case_cells(row: Row) -> tuple[str, ...]:
    """The cells of one case."""
    f = row.figures
    ratio = around(f.ratio, f.ratio_ci95, 3)
    return row.position, f"{row.cv:g}", row.case, f"{f.rms_m_s[0]:.4f}", f"{f.rms_m_s[1]:.4f}", ratio


def run(options: Options, tell: Tell) -> Spreads:
    """Design both and simulate both, at every spread."""
    default = load_config(None)
    other = parse_config(f'[retarder]\nname = "{options.retarder}"\n', "study")
    seed = default.validation.seed + FRESH
    passes = stratified_passes(seed, 0, options.passes)

    def row_of(order: tuple[ResolvedConfig, Case]) -> Row:
        config, case = order
        pair = without_price(Problem(case.plant, Aim(case.target_m_s, config.criterion)), config)
        figures = nominal(case.plant, case.target_m_s, pair, passes)
        row = Row(case.plant.position.name, case.plant.friction.common_cv, case.name, figures)
        tell(f"{row.position}, CV {row.cv:g}, {row.case}: ratio {figures.ratio:.3f}")
        return row

    orders = [
        (default, replace(case, plant=replace(case.plant, friction=replace(case.plant.friction, common_cv=cv))))
        for cv in options.spreads
        for case in class_cases(default, options.masses_t, options.targets_m_s)
    ]
    orders += [(other, case) for case in class_cases(other, options.masses_t, options.targets_m_s)]
    return Spreads(seed, options.passes, side_by_side(row_of, orders))


METHOD = Method(Options, Options(spreads=(0.05,), masses_t=(52.0,), targets_m_s=(3.0,), passes=400), Spreads, run)
