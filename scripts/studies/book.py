"""The default book as `scripts/run` tunes it, seed and all: what README and the page of results tell."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from scripts.studies.cases import of_masses
from scripts.studies.study import Findings, MarkdownTable, Method, Tell, around, option, table
from synth.frame.printed_numbers import ABSENT, few, percent
from synth.frame.workers.engine import Teller
from synth.retarder.acceptance import CaseVerdict, judged
from synth.retarder.asked_tune import RadarEpochs
from synth.retarder.case_result import CaseResult, Outcome
from synth.retarder.configuration.config_file import load_config
from synth.retarder.shown_case import ShownCase, shown_case
from synth.retarder.tune import tune
from synth.retarder.tuned_table import read_back
from synth.simulation.replicates import Interval

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHOWN: Final = 52.0, 3.0
"""Mass in t and exit speed in m/s of the case that is drawn."""


@dataclass(frozen=True)
class Options:
    """Which book."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    masses_t: tuple[float, ...] = option((), "only cuts of these masses, t")


@dataclass(frozen=True)
class Measure:
    """A figure of simulated passes with its 95 % interval."""

    value: float
    ci95: Interval

    def cell(self, digits: int) -> str:
        """'0.0419 [0.0414, 0.0425]'."""
        return around(self.value, self.ci95, digits)


@dataclass(frozen=True)
class Changed:
    """What became of a table in the condition `name`: rms, and shares of cuts."""

    name: str
    rms: Measure
    overspeed: float
    stalled: float

    @property
    def cell(self) -> str:
        """'0.0440 [0.0432, 0.0449]; 0.04, 0'."""
        return f"{self.rms.cell(4)}; {percent(self.overspeed)}, {percent(self.stalled)}"


@dataclass(frozen=True)
class Row:
    """One case of the book, in m/s and as shares; what the figures mean: docs/reference/results.md."""

    label: str
    target_m_s: float
    feasible: bool
    rms: Measure
    p95: Measure
    p99: Measure
    brake_saturated: Measure
    rms_within: Measure
    predicted_rms_m_s: float
    prediction_ratio: Measure
    regret: Measure | None
    best_baseline: str
    baseline_rms: Measure
    off_nominal: tuple[Changed, ...]


@dataclass(frozen=True)
class Results(Findings):
    """All cases; `shown`: the one with `SHOWN`, for a picture, where the book has it."""

    config_sha256: str
    seed: int
    passes: int
    rows: tuple[Row, ...]
    shown: ShownCase | None

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`results` and `off-nominal`: a row a case; `summary`: a row a class."""
        heads = ("case", "feasible", "rms", "95 of 100 within ±", "99 of 100 within ±", "brake saturated, in 10 000",
                 "rms of the others", "predicted rms", "predicted / simulated", "regret",
                 "best baseline")  # fmt: skip
        conditions = dict.fromkeys(each.name for row in self.rows for each in row.off_nominal)
        targets = tuple(dict.fromkeys(f"to {row.target_m_s:g} m/s" for row in self.rows))
        short: dict[str, list[str]] = {}
        for row in self.rows:
            short.setdefault(row.label, []).append(short_cell(row))
        return {
            "results": table("The default book, m/s", heads, map(cells, self.rows)),
            "off-nominal": table(
                "rms off nominal, m/s [95 %]; too fast, stopped inside, %",
                ("case", *conditions), (changed_cells(row, tuple(conditions)) for row in self.rows),
            ),
            "summary": table(
                "rms, m/s [95 %]; cuts in 10 000 that leave too fast whatever a table does; ° infeasible",
                ("class", *targets), ((label, *found) for label, found in short.items()),
            ),
        }  # fmt: skip

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        return (f"{self.passes} stratified passes a case, seed {self.seed}",)


def short_cell(row: Row) -> str:
    """'0.1382 [0.1354, 0.1412]°; 182'."""
    return f"{row.rms.cell(4)}{'' if row.feasible else '°'}; {few(1e4 * row.brake_saturated.value)}"


def changed_cells(row: Row, conditions: tuple[str, ...]) -> tuple[str, ...]:
    """The cells of one case off nominal."""
    found = {each.name: each.cell for each in row.off_nominal}
    return (f"{row.label} to {row.target_m_s:g} m/s", *(found.get(name, ABSENT) for name in conditions))


def cells(row: Row) -> tuple[str, ...]:
    """The cells of one case."""
    most, (low, high) = 1e4 * row.brake_saturated.value, (1e4 * end for end in row.brake_saturated.ci95)
    return (
        f"{row.label} to {row.target_m_s:g} m/s", "yes" if row.feasible else "no", row.rms.cell(4), row.p95.cell(3),
        row.p99.cell(3), f"{few(most)} [{few(low)}, {few(high)}]", row.rms_within.cell(4),
        f"{row.predicted_rms_m_s:.4f}", row.prediction_ratio.cell(3),
        ABSENT if row.regret is None else row.regret.cell(3),
        f"{row.baseline_rms.cell(4)} ({row.best_baseline})",
    )  # fmt: skip


def run(options: Options, tell: Tell) -> Results:
    """Tune the book."""
    config = of_masses(load_config(options.config), options.masses_t)
    book = tune(config, RadarEpochs(), read_back, Teller(tell))
    rows = tuple(map(row_of, book.whole, judged(book.whole, config.acceptance)))
    shown = (shown_case(case) for case in book.whole if (case.plant.cut.mass_t, case.target_speed_m_s) == SHOWN)
    return Results(config.sha256, config.validation.seed, config.validation.passes, rows, next(shown, None))


def row_of(case: CaseResult, verdict: CaseVerdict) -> Row:
    """One case of a book."""
    table, found, power = case.measured, case.statistics, case.brake_power
    best, compared = case.comparison.best_baseline, case.comparison
    assert best is not None
    assert power.rms_within_m_s is not None
    assert power.rms_within_ci95_m_s is not None
    return Row(
        label=case.label,
        target_m_s=case.target_speed_m_s,
        feasible=verdict.feasible,
        rms=Measure(found.rms_m_s, found.rms_ci95_m_s),
        p95=Measure(found.p95_m_s, found.p95_ci95_m_s),
        p99=Measure(found.p99_m_s, found.p99_ci95_m_s),
        brake_saturated=Measure(power.brake_saturated, power.brake_saturated_ci95),
        rms_within=Measure(power.rms_within_m_s, power.rms_within_ci95_m_s),
        predicted_rms_m_s=table.predicted_rms_m_s,
        prediction_ratio=Measure(table.prediction_ratio, table.prediction_ratio_ci95),
        regret=Measure(compared.regret, compared.regret_ci95) if compared.has_reference else None,
        best_baseline=best.name,
        baseline_rms=Measure(best.statistics.rms_m_s, best.statistics.rms_ci95_m_s),
        off_nominal=tuple(changed(each.name, each.outcome) for each in case.off_nominal if each.outcome),
    )


def changed(name: str, found: Outcome) -> Changed:
    """One condition."""
    return Changed(name, Measure(found.rms_m_s, found.rms_ci95_m_s), found.overspeed, found.stalled)


METHOD = Method(Options, Options(masses_t=(52.0,)), Results, run)


def figures(found: Results) -> Mapping[str, Figure]:
    """The case that is shown, where the book has it."""
    from synth.retarder.pictures.exits import case_picture

    return {} if found.shown is None else {"case": case_picture(found.shown)}
