"""How much reserve lines for the estimated speed should keep, and what it costs: a row for each case and each
uncertainty of the mean friction.

For every case the tables that `tune` would write with several uncertainties of the mean friction, 0 first, and the
table without estimator; all of them on the same fresh passes, on the plant that they were made for and on plants that
brake otherwise. Where `tune` would leave the estimator out, the table without it stands for the one with it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median

import numpy as np

from scripts.studies.cases import Case, class_cases, side_by_side
from scripts.studies.estimator.pair import FRESH, Both, as_tuned, compared
from scripts.studies.estimator.wrong_study import braking_otherwise
from scripts.studies.study import Findings, MarkdownTable, Method, Tell, option, span, table
from synth.problem.problem import OVERSPEED_M_S, Aim, Problem
from synth.retarder.configuration.config_file import load_config, parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.simulation.closed_loop import simulate
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.simulation.replicates import REPLICATE_PASSES, Interval
from synth.simulation.stratified_passes import stratified_passes

HIGHEST_PRICE, HIGHEST_RATIO = 1.05, 1.03
"""What a reserve may cost on the plant that it was made for, and how much worse than without it may be elsewhere."""


@dataclass(frozen=True)
class Excess:
    """On which plant most more cuts leave outside 0.3 m/s: shares without estimator and with it, and what is between.

    `half_width`: of the 95 % interval of the paired difference `more`.
    """

    plant: str
    outside: Both
    more: float
    half_width: float

    @property
    def sure(self) -> bool:
        """Whether there are more at all, beyond the interval."""
        return self.more > self.half_width


@dataclass(frozen=True)
class Row:
    """One uncertainty of the mean.

    `rms_m_s`, `ratio`, `outside`: on the plant that the table was made for;
    `price`: rms / that of the first row; `worst_…`: the largest ratio to the rms without estimator, and on which plant.
    """

    mean_cv: float
    rms_m_s: float
    price: float
    ratio: float
    worst_plant: str
    worst_ratio: float
    worst_ci95: Interval
    outside: Both
    most: Excess


@dataclass(frozen=True)
class CaseRows:
    """One case."""

    case: str
    rows: tuple[Row, ...]


@dataclass(frozen=True)
class Reserves(Findings):
    """All cases; `assumed`: the uncertainty that the configuration has."""

    config_sha256: str
    seed: int
    passes: int
    assumed: float
    cases: tuple[CaseRows, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`curve`: a row an uncertainty, all cases together; `cases`: a row a case, none and the assumed one."""
        heads = (
            "mean_cv", "rms / that at 0: median, largest", "rms / without estimator: median",
            "largest, over all plants", f"cases above {HIGHEST_RATIO:g}", "cases with more outside 0.3 m/s",
            "most more",
        )  # fmt: skip
        curve = [
            curve_cells([case.rows[i] for case in self.cases], [case.case for case in self.cases])
            for i in range(len(self.cases[0].rows))
        ]
        each = ("case", "rms, m/s", "ratio to 0", "worst ratio at 0", "worst ratio [95 %]", "outside 0.3 m/s, %")
        cases = [case_cells(case.case, case.rows[0], row) for case, row in self.assumed_rows()]
        return {
            "curve": table("What a reserve costs and gives", heads, curve),
            "cases": table(f"rms without reserve and with mean_cv = {self.shown:g}", each, cases),
        }

    def assumed_rows(self) -> list[tuple[CaseRows, Row]]:
        """Every case with its row of the assumed uncertainty, or the last where it was not studied."""
        return [
            (case, next((row for row in case.rows if row.mean_cv == self.assumed), case.rows[-1]))
            for case in self.cases
        ]

    @property
    def shown(self) -> float:
        """The uncertainty of the rows that `assumed_rows` gives."""
        return self.assumed_rows()[0][1].mean_cv

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        return (f"{self.passes} fresh stratified passes of each table on each plant, seed {self.seed}",)

    def faults(self) -> tuple[str, ...]:
        """Cases that cost or lose more than a reserve may, beyond their interval."""
        dear = [
            f"{case.case}: rms {row.price:.3f} times that without reserve"
            for case, row in self.assumed_rows()
            if row.price > HIGHEST_PRICE
        ]
        worse = [
            f"{case.case}: with {row.worst_plant} worse than without estimator, ratio {row.worst_ratio:.3f}"
            for case, row in self.assumed_rows()
            if row.worst_ci95[0] > HIGHEST_RATIO
        ]
        return (*dear, *worse)


def curve_cells(rows: Sequence[Row], names: Sequence[str]) -> tuple[str, ...]:
    """All cases with one uncertainty."""
    prices = [row.price for row in rows]
    worst = max(range(len(rows)), key=lambda i: rows[i].worst_ratio)
    most = max(range(len(rows)), key=lambda i: rows[i].most.more)
    excess = rows[most].most
    return (
        f"{rows[0].mean_cv:g}",
        f"{median(prices):.3f}, {max(prices):.3f}", f"{median(row.ratio for row in rows):.3f}",
        f"{rows[worst].worst_ratio:.3f} ({names[worst]}, {rows[worst].worst_plant})",
        f"{sum(row.worst_ratio > HIGHEST_RATIO for row in rows)}", f"{sum(row.most.sure for row in rows)}",
        f"{100 * excess.outside[0]:.2f} → {100 * excess.outside[1]:.2f} % ({names[most]}, {excess.plant})",
    )  # fmt: skip


def case_cells(name: str, first: Row, row: Row) -> tuple[str, ...]:
    """One case without reserve and with it."""
    return (
        name, f"{first.rms_m_s:.4f} → {row.rms_m_s:.4f}", f"{row.price:.3f}",
        f"{first.worst_ratio:.3f} ({first.worst_plant})",
        f"{row.worst_ratio:.3f} {span(row.worst_ci95, 3)} ({row.worst_plant})",
        f"{100 * row.outside[0]:.3f}: {100 * first.outside[1]:.3f} → {100 * row.outside[1]:.3f}",
    )  # fmt: skip


OTHERS = (
    ("park", '[position]\nname = "rnz-2m-park"\n[[cut]]\ncar = "gondola-4"\nmass_t = 36\n'),
    ("three cars", '[targets]\nexit_speeds_m_s = [4.0]\n[[cut]]\ncar = "gondola-4"\ncars = 3\nmass_t = 156\n'),
    ("8 axles", '[[cut]]\ncar = "tank-8"\nmass_t = 120\n'),
)
"""Cases besides those of the configuration: name, configuration."""


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    masses_t: tuple[float, ...] = option((), "only cuts of these masses, t")
    targets_m_s: tuple[float, ...] = option((), "exit speeds, m/s; those of the configuration without it", (0.1, 20.0))
    mean_cvs: tuple[float, ...] = option(
        (0.0, 0.06, 0.08, 0.1, 0.15), "friction.mean_cv, compared to the first", (0, 0.3)
    )
    others: int = option(len(OTHERS), "how many of the other plants", (0, len(OTHERS)))
    passes: int = option(20_000, "fresh passes of each case", (200, 10**7))


def run(options: Options, tell: Tell) -> Reserves:
    """Tune all tables, simulate all on every plant."""
    config = load_config(options.config)
    seed = config.validation.seed + FRESH
    passes = stratified_passes(seed, 0, options.passes)

    def rows_of(order: tuple[str, ResolvedConfig, Case]) -> CaseRows:
        name, own, case = order
        rows = tuple(reserve_rows(own, case, passes, options.mean_cvs))
        told = ", ".join(f"{row.worst_ratio:.3f} ({row.worst_plant})" for row in rows)
        tell(f"{name}: worst ratio {told}")
        return CaseRows(name, rows)

    orders = [(case.name, config, case) for case in class_cases(config, options.masses_t, options.targets_m_s)]
    for name, text in OTHERS[: options.others]:
        other = parse_config(text, name)
        orders += [(f"{name}, {case.name}", other, case) for case in class_cases(other, (), ())]
    assumed = config.retarder.friction.mean_cv
    return Reserves(config.sha256, seed, options.passes, assumed, side_by_side(rows_of, orders))


def reserve_rows(config: ResolvedConfig, case: Case, passes: RandomPasses, mean_cvs: Sequence[float]) -> Iterator[Row]:
    """One case with each uncertainty of the mean."""
    plants = {wrong.name: wrong.plant for wrong in braking_otherwise(case.plant)}
    without: dict[str, ExitSample] = {}
    nominal = next(iter(plants))
    first = 0.0
    for mean_cv in mean_cvs:
        friction = replace(case.plant.friction, mean_cv=mean_cv)
        problem = Problem(replace(case.plant, friction=friction), Aim(case.target_m_s, config.criterion))
        pair = as_tuned(problem, config, case.label)
        without = without or {name: simulate(plant, pair.plain, passes) for name, plant in plants.items()}
        with_it = {name: simulate(plant, pair.estimated, passes) for name, plant in plants.items()}
        found = {name: compared(case.target_m_s, without[name], with_it[name]) for name in plants}
        rms = found[nominal].rms_m_s[1]
        first = first or rms
        worst = max(found, key=lambda name: found[name].ratio)
        excess = {name: excess_outside((without[name], with_it[name]), case.target_m_s) for name in plants}
        most = max(excess, key=lambda name: excess[name][0])
        yield Row(
            mean_cv=mean_cv,
            rms_m_s=rms,
            price=rms / first,
            ratio=found[nominal].ratio,
            worst_plant=worst,
            worst_ratio=found[worst].ratio,
            worst_ci95=found[worst].ratio_ci95,
            outside=found[nominal].outside,
            most=Excess(most, found[most].outside, *excess[most]),
        )


def excess_outside(samples: tuple[ExitSample, ExitSample], target_m_s: float) -> Both:
    """By how much more of all cuts the second leaves outside, and the half width of its 95 % interval; paired."""
    weight = samples[0].weight
    far = [np.abs(sample.exit_speed_m_s - target_m_s) > OVERSPEED_M_S for sample in samples]
    more = weight * (far[1].astype(np.float64) - far[0])
    by_replicate = more[: len(more) // REPLICATE_PASSES * REPLICATE_PASSES].reshape(-1, REPLICATE_PASSES).mean(axis=1)
    spread = float(by_replicate.std(ddof=1)) / np.sqrt(len(by_replicate))
    return float(more.sum() / weight.sum()), float(1.96 * spread)


METHOD = Method(Options, Options(None, (52.0,), (3.0,), (0.0, 0.15), 0, 400), Reserves, run)
