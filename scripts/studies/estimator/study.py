"""What is gained when the regulator compares an estimated speed with its lines.

For every case lines for the measured speed and lines for the estimated one, both polished and without a price on
switchings, on the same fresh passes; and the reference that is told the friction of every cut, on the same passes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median

from scripts.studies.cases import THOROUGH, Case, class_cases, side_by_side, simulate_told, thorough, told_friction
from scripts.studies.estimator.pair import FRESH, Compared, nominal, without_price
from scripts.studies.study import Findings, MarkdownTable, Method, Tell, around, option, table
from synth.problem.problem import Aim, Problem
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.random_passes import RandomPasses
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.chain.chain import persistent_chain
from synth.solver.told_lines import Effort

FINE_STEP_M_S = 0.02
"""Speed step of the reference."""


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    masses_t: tuple[float, ...] = option((22.0, 52.0, 85.0), "only cuts of these masses, t")
    targets_m_s: tuple[float, ...] = option((), "exit speeds, m/s; those of the configuration without it", (0.1, 20.0))
    passes: int = option(20_000, "fresh passes of each case", (200, 10**7))
    told_nodes: int = option(THOROUGH.frictions, "factors of friction with lines of their own", (1, 31))
    told_iterations: int = option(THOROUGH.iterations[0], "of a polish with the friction told", (1, 10_000))


@dataclass(frozen=True)
class Row:
    """One case; `error_m_s`: std of the estimated speed's error in the closed loop; rms where the friction is told."""

    case: str
    error_m_s: float
    told_rms_m_s: float
    figures: Compared


@dataclass(frozen=True)
class Gains(Findings):
    """All cases."""

    config_sha256: str
    seed: int
    passes: int
    rows: tuple[Row, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`gains`: a row a case; `told`: over the rms of a regulator without estimator that is told the friction."""
        heads = ("case", "without", "with estimator", "ratio [95 %]", "bias", "switchings", "told the friction",
                 "error of the speed")  # fmt: skip
        over = ("controller", "least", "median", "largest")
        rows = (("without estimator", self.over_told(0)), ("with estimator", self.over_told(1)))
        told = [(name, *(f"{x:.2f}" for x in (min(all_), median(all_), max(all_)))) for name, all_ in rows]
        return {
            "gains": table("rms without and with estimator, m/s", heads, map(cells, self.rows)),
            "told": table("rms / rms where the friction of every cut is told, without estimator", over, told),
        }

    def over_told(self, which: int) -> list[float]:
        """rms / rms where the friction is told, in every case; `which`: 0 without estimator, 1 with it."""
        return [row.figures.rms_m_s[which] / row.told_rms_m_s for row in self.rows]

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        ratios = [row.figures.ratio for row in self.rows]
        return (
            f"{self.passes} fresh stratified passes each, seed {self.seed}",
            f"ratio: median {median(ratios):.3f}, {min(ratios):.3f} to {max(ratios):.3f}",
        )

    def faults(self) -> tuple[str, ...]:
        """Cases in which the estimator is worse beyond the interval."""
        return tuple(
            f"{row.case}: with the estimator worse, ratio {around(row.figures.ratio, row.figures.ratio_ci95, 3)}"
            for row in self.rows
            if row.figures.ratio_ci95[0] > 1.0
        )


def cells(row: Row) -> tuple[str, ...]:
    """The cells of one case."""
    f = row.figures
    return (
        row.case, f"{f.rms_m_s[0]:.4f}", f"{f.rms_m_s[1]:.4f}", around(f.ratio, f.ratio_ci95, 3),
        f"{f.bias_m_s[0]:+.4f} / {f.bias_m_s[1]:+.4f}", f"{f.switchings[0]:.1f} / {f.switchings[1]:.1f}",
        f"{row.told_rms_m_s:.4f}", f"{row.error_m_s:.4f}",
    )  # fmt: skip


def run(options: Options, tell: Tell) -> Gains:
    """Design both, simulate both, and find the reference."""
    config = load_config(options.config)
    seed = config.validation.seed + FRESH
    passes = stratified_passes(seed, 0, options.passes)

    def row_of(case: Case) -> Row:
        pair = without_price(Problem(case.plant, Aim(case.target_m_s, config.criterion)), config)
        figures = nominal(case.plant, case.target_m_s, pair, passes)
        effort = thorough(options.told_nodes, options.told_iterations)
        row = Row(case.name, pair.error_m_s, told_rms_m_s(case, config, passes, effort), figures)
        tell(f"{row.case}: {figures.rms_m_s[0]:.4f} without, {figures.rms_m_s[1]:.4f} with estimator")
        return row

    rows = side_by_side(row_of, class_cases(config, options.masses_t, options.targets_m_s))
    return Gains(config.sha256, seed, options.passes, rows)


def told_rms_m_s(case: Case, config: ResolvedConfig, passes: RandomPasses, effort: Effort) -> float:
    """rms where the regulator is told the friction of every cut, and looks at the measured speed."""
    finer = replace(config.resolution, speed_step_m_s=min(config.resolution.speed_step_m_s, FINE_STEP_M_S))
    found = told_friction(persistent_chain(case.plant, finer), case.target_m_s, config.fit.degree, effort)
    return exit_statistics(simulate_told(case.plant, found, passes), case.target_m_s).rms_m_s


METHOD = Method(
    Options, Options(masses_t=(52.0,), targets_m_s=(3.0,), passes=400, told_nodes=1, told_iterations=1), Gains, run
)
