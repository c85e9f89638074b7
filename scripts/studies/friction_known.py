"""How good the friction-known reference of a tune is: beside one with finer steps, and one with much more effort.

The reference of a tune takes one step of the polish at most frictions, on the design grid. Here its lines are polished
to the end on the grid of the prediction, with a higher degree and the resistance's spread; and single choices of the
tune are refined: the frictions with lines of their own, the groups in which cuts are told theirs. All on the same
passes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median

import numpy as np

from scripts.studies.cases import Case, class_cases
from scripts.studies.markdown_table import MarkdownTable, around, table
from scripts.studies.options import option
from scripts.studies.side_by_side import side_by_side
from scripts.studies.study import Findings, Method, Tell
from scripts.studies.told_friction import THOROUGH
from scripts.studies.tuned_table import CREATED
from synth.problem.aim import Aim
from synth.retarder.class_setup import ClassSetup, class_setup, origin_of
from synth.retarder.comparison.friction_bound import bound_of
from synth.retarder.comparison.told_regulator import best_by_others, by_lines, run_told
from synth.retarder.configuration.config_file import load_config
from synth.retarder.tuned_table import solutions, tuned_table
from synth.simulation.closed_loop import TableController
from synth.simulation.exit_statistics import rms_ratio
from synth.simulation.replicates import Interval
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.chain.chain import persistent_chain
from synth.solver.told_lines import IN_A_TUNE, told_lines

FRESH = 15485863
"""Added to the configured seed."""


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    masses_t: tuple[float, ...] = option((), "only cuts of these masses, t")
    targets_m_s: tuple[float, ...] = option((), "exit speeds, m/s; those of the configuration without it", (0.1, 20.0))
    passes: int = option(20_000, "fresh passes of each case", (200, 10**7))
    degree: int = option(9, "of the lines polished with more effort", (1, 20))
    iterations: int = option(30, "of their polish at each friction", (1, 10_000))
    frictions: int = option(25, "that have lines of their own, instead of those of a tune", (3, 201))
    groups: int = option(104, "in which cuts are told their friction, instead of those of a tune", (2, 10_000))


@dataclass(frozen=True)
class Ratio:
    """Of two rms on the same passes, with its 95 % interval."""

    value: float
    ci95: Interval

    @property
    def cell(self) -> str:
        """'1.088 [1.080, 1.097]'."""
        return around(self.value, self.ci95, 3)


@dataclass(frozen=True)
class Row:
    """One case: regret of its table; rms of the tune's reference / rms with more effort, frictions, groups."""

    case: str
    regret: Ratio
    loose: Ratio
    frictions: Ratio
    groups: Ratio


@dataclass(frozen=True)
class References(Findings):
    """All cases."""

    config_sha256: str
    seed: int
    passes: int
    rows: tuple[Row, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`references`: a row a case."""
        heads = ("case", "regret", "reference / with more effort", "/ with more frictions", "/ with more groups")
        rows = ((row.case, row.regret.cell, row.loose.cell, row.frictions.cell, row.groups.cell) for row in self.rows)
        return {"references": table("rms of the friction-known reference", heads, rows)}

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated, and the extremes."""
        regrets, loose = [row.regret.value for row in self.rows], [row.loose.value for row in self.rows]
        return (
            f"{self.passes} stratified passes each, seed {self.seed}",
            f"regret: {min(regrets):.3f} to {max(regrets):.3f}, median {median(regrets):.3f}",
            f"reference / with more effort: {min(loose):.3f} to {max(loose):.3f}, median {median(loose):.3f}",
        )

    def faults(self) -> tuple[str, ...]:
        """Tables that beat their reference beyond the interval."""
        return tuple(
            f"{row.case}: the table beats its reference, {row.regret.cell}" for row in self.rows
            if row.regret.ci95[1] < 1.0
        )  # fmt: skip


def run(options: Options, tell: Tell) -> References:
    """All cases."""
    config = load_config(options.config)
    seed = config.validation.seed + FRESH

    def row_of(case: Case) -> Row:
        passes = stratified_passes(seed, 0, options.passes)
        setup = class_setup(config, case.label, case.plant, passes, origin_of("0" * 64, CREATED))
        row = compared(replace(setup, estimator=None), Aim(case.target_m_s, config.criterion), case.name, options)
        tell(f"{row.case}: regret {row.regret.cell}, reference / with more effort {row.loose.cell}")
        return row

    cases = class_cases(config, options.masses_t, options.targets_m_s)
    return References(config.sha256, seed, options.passes, side_by_side(row_of, cases))


def compared(setup: ClassSetup, aim: Aim, name: str, options: Options) -> Row:
    """One case."""
    target, common = aim.target_speed_m_s, setup.passes
    tuned = tuned_table(setup, solutions(setup.design, [aim])[0])
    sample = common.run(TableController(tuned.table))
    told = by_lines(told_lines(setup.design, target, tuned.design.kept.lines, tuned.design.fit.curvature))
    bound = bound_of(common, [told], sample, target)
    finer = replace(IN_A_TUNE, frictions=options.frictions)
    more = by_lines(told_lines(setup.design, target, tuned.design.kept.lines, tuned.design.fit.curvature, finer))
    effort = replace(THOROUGH, degree=options.degree, iterations=(options.iterations, options.iterations))
    fine = replace(persistent_chain(setup.plant, setup.check.resolution), scenarios=setup.design.scenarios)
    quanta, coarse = len(fine.grid.path_m) - 1, tuned.design.fit.curvature.shape[2]
    # Half the path step, but not always twice the quanta: both grids round their number.
    curvature = tuned.design.fit.curvature[:, :, np.arange(quanta) * coarse // quanta]
    best = by_lines(told_lines(fine, target, tuned.design.kept.lines, curvature, effort))
    in_tune, by_more, by_effort = (run_told(common.loop, common.draws, each) for each in (told, more, best))
    in_groups = run_told(common.loop, common.draws, told, options.groups)
    thorough = best_by_others([by_effort, in_tune, sample], target)
    return Row(
        case=name,
        regret=Ratio(*rms_ratio(sample, bound, target)),
        loose=Ratio(*rms_ratio(bound, thorough, target)),
        frictions=Ratio(*rms_ratio(in_tune, by_more, target)),
        groups=Ratio(*rms_ratio(in_tune, in_groups, target)),
    )


SMALLEST = Options(masses_t=(52.0,), targets_m_s=(3.0,), passes=400, degree=3, iterations=1, frictions=3, groups=2)
METHOD = Method(Options, SMALLEST, References, run)
