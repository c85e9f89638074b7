"""What is lost by lines between two tables of a book, against a table tuned for the very speed commanded.

A book is tuned with targets a step apart, and tables at equal parts of every step. At each part the lines between the
two tables of the book are compared with the table tuned for that speed, on the same passes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from plant_models import Plant
from scripts.studies.cases import lines_of_solution, of_masses, rounded, side_by_side
from scripts.studies.study import Findings, MarkdownTable, Method, Tell, option, span, table
from synth.problem.problem import Aim
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.simulation.closed_loop import TableController, simulate
from synth.simulation.random_passes import RandomPasses
from synth.simulation.replicates import Interval, mean_of, rms_of
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.backward_induction import solve_all
from synth.solver.chain.chain import persistent_chain
from tuning_tables import ControllerTable
from tuning_tables.table_book import Status, TableBook

FRESH = 104729
"""Added to the configured seed: passes that no tuning has seen."""


@dataclass(frozen=True)
class Options:
    """What is compared."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    masses_t: tuple[float, ...] = option((), "only cuts of these masses, t")
    passes: int = option(20_000, "passes of each table", (200, 10**7))
    step_m_s: float = option(1.0, "between the targets of the book, m/s", (0.1, 5.0))
    parts: int = option(4, "equal parts of a step", (2, 100))


@dataclass(frozen=True)
class Row:
    """One commanded speed: the table tuned for it beside what a book makes of it.

    `between`: no table of the book is for this speed. `excess_m2_s2`: mean square of the lines of the book less that of
    the tuned ones, paired.
    """

    label: str
    target_m_s: float
    between: bool
    tuned_rms_m_s: float
    book_rms_m_s: float
    book_bias_m_s: float
    excess_m2_s2: float
    excess_ci95_m2_s2: Interval


@dataclass(frozen=True)
class Interpolated(Findings):
    """All commanded speeds of all classes of cuts."""

    config_sha256: str
    seed: int
    passes: int
    rows: tuple[Row, ...]

    @property
    def between(self) -> tuple[Row, ...]:
        """The speeds between tables."""
        return tuple(row for row in self.rows if row.between)

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`worst`: a row a class of cuts; `between`: a row a speed between two tables."""
        heads = (
            "class",
            "target, m/s",
            "tuned rms",
            "rms between",
            "bias between",
            "excess of the mean square, mm²/s² [95 %]",
        )
        rows = [
            (row.label, f"{row.target_m_s:g}", f"{row.tuned_rms_m_s:.4f}", f"{row.book_rms_m_s:.4f}",
             f"{row.book_bias_m_s:+.4f}", f"{1e6 * row.excess_m2_s2:.0f} {span(row.excess_ci95_m2_s2, 0, 1e6)}")
            for row in self.between
        ]  # fmt: skip
        worst = ("class", "largest rise of the rms", "tuned rms there", "at", "95 % interval shows no loss")
        return {
            "worst": table("The largest loss of each class, m/s", worst, map(worst_of, self.by_class())),
            "between": table("Lines between two tables of a book, m/s", heads, rows),
        }

    def by_class(self) -> tuple[tuple[Row, ...], ...]:
        """The speeds between tables, class by class."""
        labels = dict.fromkeys(row.label for row in self.between)
        return tuple(tuple(row for row in self.between if row.label == label) for label in labels)

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        return (f"{self.passes} stratified passes each, seed {self.seed}; {len(self.between)} speeds between tables",)


def worst_of(rows: Sequence[Row]) -> tuple[str, ...]:
    """The cells of one class."""
    worst = max(rows, key=lambda row: row.book_rms_m_s - row.tuned_rms_m_s)
    rise, share = worst.book_rms_m_s - worst.tuned_rms_m_s, worst.book_rms_m_s / worst.tuned_rms_m_s - 1.0
    kept = sum(row.excess_ci95_m2_s2[0] <= 0.0 for row in rows)
    most = f"{rise:.4f} ({100.0 * share:.1f} %)" if rise > 0.0 else "none"
    return worst.label, most, f"{worst.tuned_rms_m_s:.4f}", f"{worst.target_m_s:g} m/s", f"{kept} of {len(rows)} speeds"


def run(options: Options, tell: Tell) -> Interpolated:
    """Tune, choose between tables, simulate."""
    config = of_masses(load_config(options.config), options.masses_t)
    seed = config.validation.seed + FRESH
    passes = stratified_passes(seed, 0, options.passes)

    def rows_of(item: tuple[str, Plant]) -> list[Row]:
        label, plant = item
        targets = parted(config.targets_of(label), options.step_m_s, options.parts)
        rows = compared(label, plant, tuned_tables(config, plant, targets), options.parts, passes)
        tell(f"{label}: {len(rows)} speeds")
        return rows

    found = side_by_side(rows_of, config.plants())
    return Interpolated(config.sha256, seed, options.passes, tuple(row for rows in found for row in rows))


def parted(targets_m_s: Sequence[float], step_m_s: float, parts: int) -> list[float]:
    """All commanded speeds: equal parts of whole steps from the lowest to about the highest target."""
    low, high = min(targets_m_s), max(targets_m_s)
    steps = max(1, round((high - low) / step_m_s))
    return [float(target) for target in np.linspace(low, high, steps * parts + 1)]


def tuned_tables(config: ResolvedConfig, plant: Plant, targets: list[float]) -> list[ControllerTable]:
    """A table for each target of one class, as in a tune, without its other controllers."""
    design = persistent_chain(plant, config.resolution)
    solutions = solve_all(design, [Aim(target, config.criterion) for target in targets])
    lines = [(lines_of_solution(each, config.fit.degree), each.aim.target_speed_m_s) for each in solutions]
    return [rounded(config, plant, own, target) for own, target in lines]


def compared(label: str, plant: Plant, tables: list[ControllerTable], parts: int, passes: RandomPasses) -> list[Row]:
    """Lines of a book of every `parts`-th table beside each of the tables."""
    book, rows = TableBook(tuple(tables[::parts])), []
    for tuned in tables:
        target = tuned.target_speed_m_s
        choice = book.choose(plant.cut.category, len(plant.cut.axle_offsets_m), target)
        assert choice.table is not None, f"the book has no lines to {target:g} m/s"
        own, other = (simulate(plant, TableController(each), passes) for each in (tuned, choice.table))
        weight, error, between = own.weight, own.exit_speed_m_s - target, other.exit_speed_m_s - target
        excess = mean_of(between**2 - error**2, weight)
        rows.append(
            Row(
                label, target, choice.status is Status.BETWEEN, rms_of(error, weight)[0], rms_of(between, weight)[0],
                mean_of(between, weight).value, excess.value, excess.ci95,
            )
        )  # fmt: skip
    return rows


METHOD = Method(Options, Options(masses_t=(52.0,), passes=400, parts=2), Interpolated, run)
