"""What the estimator costs where it is wrong: the tables that `tune` writes, on plants they were not made for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from scripts.studies.cases import Case, class_cases
from scripts.studies.estimator.pair import FRESH, Both, Compared, as_tuned, compared
from scripts.studies.estimator.wrong import LOST, simulated, wrongs
from scripts.studies.markdown_table import MarkdownTable, span, table
from scripts.studies.options import option
from scripts.studies.side_by_side import side_by_side
from scripts.studies.study import Findings, Method, Tell
from synth.problem.aim import Aim
from synth.problem.problem import Problem
from synth.retarder.configuration.config_file import load_config
from synth.simulation.closed_loop import simulate
from synth.simulation.stratified_passes import stratified_passes


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    masses_t: tuple[float, ...] = option((36.0, 52.0), "only cuts of these masses, t")
    targets_m_s: tuple[float, ...] = option((2.0, 3.0), "exit speeds, m/s", (0.1, 20.0))
    passes: int = option(40_000, "fresh passes of each case", (200, 10**7))


@dataclass(frozen=True)
class CaseRow:
    """One case: figures by what is wrong.

    `without_reserve`: the same for lines that are designed for a mean friction that is known, `friction.mean_cv` = 0.
    """

    case: str
    by_wrong: dict[str, Compared]
    without_reserve: dict[str, Compared]


@dataclass(frozen=True)
class Misled(Findings):
    """All cases."""

    config_sha256: str
    seed: int
    passes: int
    cases: tuple[CaseRow, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`wrong`: a row for what is wrong, a column a case; `lost`: a row a case, the sensor lost for good."""
        names = [name for name in self.cases[0].by_wrong if name != LOST]
        rows = [(name, *(ratio_cell(case.without_reserve[name], case.by_wrong[name]) for case in self.cases))
                for name in names]  # fmt: skip
        heads = ("case", "rms, m/s, without → with", "stalled, %", "too fast by 0.3 m/s, %", "outside 0.3 m/s, %")
        return {
            "wrong": table(
                "rms with / without estimator, without reserve → with it [95 %]; share outside 0.3 m/s, %: without "
                "estimator, with it, with it and a reserve",
                ("plant", *(case.case for case in self.cases)), rows,
            ),
            "lost": table("A sensor that is lost for good", heads, map(lost_cells, self.cases)),
        }  # fmt: skip

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        return (f"{self.passes} fresh stratified passes each, seed {self.seed}",)


def ratio_cell(before: Compared, found: Compared) -> str:
    """'**1.245** → 0.960 [0.951, 0.970]; 0.79, 1.53, 0.77': bold where worse beyond the interval."""
    first, last = (f"**{x.ratio:.3f}**" if x.ratio_ci95[0] > 1.0 else f"{x.ratio:.3f}" for x in (before, found))
    shares = ", ".join(f"{100.0 * share:.2f}" for share in (found.outside[0], before.outside[1], found.outside[1]))
    return f"{first} → {last} {span(found.ratio_ci95, 3)}; {shares}"


def lost_cells(case: CaseRow) -> tuple[str, ...]:
    """The cells of one case."""
    found = case.by_wrong[LOST]
    rms = f"{found.rms_m_s[0]:.2f} → {found.rms_m_s[1]:.2f}"
    return case.case, rms, percent(found.stalled, 1), percent(found.overspeed, 1), percent(found.outside, 0)


def percent(shares: Both, digits: int) -> str:
    """'3.79 → 6.01'."""
    return " → ".join(f"{100.0 * share:.{digits}f}" for share in shares)


def run(options: Options, tell: Tell) -> Misled:
    """Tune both tables, simulate both on every plant."""
    config = load_config(options.config)
    seed = config.validation.seed + FRESH
    passes = stratified_passes(seed, 0, options.passes)

    def row_of(case: Case) -> CaseRow:
        known = replace(case.plant, friction=replace(case.plant.friction, mean_cv=0.0))
        aim = Aim(case.target_m_s, config.criterion)
        before, pair = (as_tuned(Problem(plant, aim), config, case.label) for plant in (known, case.plant))
        transit_s = simulate(case.plant, pair.plain, passes).transit_time_s.astype(np.float64)
        found: tuple[dict[str, Compared], dict[str, Compared]] = ({}, {})
        for wrong in wrongs(case.plant, seed):
            plain = simulated(wrong, pair.plain, passes, transit_s)
            for figures, each in zip(found, (before, pair), strict=True):
                estimated = simulated(wrong, each.misled(wrong.gauge), passes, transit_s)
                figures[wrong.name] = compared(case.target_m_s, plain, estimated)
        tell(f"{case.name}: {len(found[0])} plants and faults")
        return CaseRow(case.name, found[1], found[0])

    rows = side_by_side(row_of, class_cases(config, options.masses_t, options.targets_m_s))
    return Misled(config.sha256, seed, options.passes, rows)


METHOD = Method(Options, Options(masses_t=(52.0,), targets_m_s=(3.0,), passes=400), Misled, run)
