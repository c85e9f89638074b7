"""What the study of the reserve finds: for each case and each uncertainty of the mean friction one row."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median

from scripts.studies.estimator.pair import Both
from scripts.studies.markdown_table import MarkdownTable, span, table
from scripts.studies.study import Findings
from synth.simulation.replicates import Interval

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
