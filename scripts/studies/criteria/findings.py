"""What the study `criteria` has found: a row a criterion, a row a price on switchings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from scripts.studies.markdown_table import MarkdownTable, around, table
from scripts.studies.study import Findings
from synth.simulation.replicates import Interval


@dataclass(frozen=True)
class Measured:
    """One table on the common passes; `over`: share beyond each margin above the target, with its interval."""

    predicted_rms_m_s: float
    rms_m_s: float
    rms_ci95_m_s: Interval
    bias_m_s: float
    bias_ci95_m_s: Interval
    over: tuple[tuple[float, Interval], ...]
    stalled: float
    switchings: float
    switchings_ci95: Interval


@dataclass(frozen=True)
class CriterionRow:
    """One criterion of one case. `ratio`: rms / rms by the default, paired; `worst_factor`: of friction, with its rms.

    `finding`: what the requirement took, in a sentence.
    """

    case: str
    criterion: str
    figures: Measured
    ratio: float
    ratio_ci95: Interval
    worst_factor: float
    worst_rms_m_s: float
    worst_ci95_m_s: Interval
    finding: str | None


@dataclass(frozen=True)
class PriceRow:
    """The default criterion with one switching tolerance."""

    case: str
    tolerance_m2_s2: float
    figures: Measured


@dataclass(frozen=True)
class Criteria(Findings):
    """All criteria and prices of all cases. `margins_m_s`: those of `Measured.over`."""

    config_sha256: str
    seed: int
    passes: int
    margins_m_s: tuple[float, ...]
    criteria: tuple[CriterionRow, ...]
    prices: tuple[PriceRow, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`criteria`: a row a case and criterion; `prices`: a row a tolerance, a column a case."""
        beyond = (f"P(+{margin:g})" for margin in self.margins_m_s)
        heads = ("case", "criterion", "rms", "rms / default", "bias", *beyond, "switchings", "worst rms, at factor")
        cases = tuple(dict.fromkeys(row.case for row in self.prices))
        by_price: dict[float, list[str]] = {}
        for row in self.prices:
            cell = f"{mm(row.figures.rms_m_s, row.figures.rms_ci95_m_s)} / {row.figures.switchings:.2f}"
            by_price.setdefault(row.tolerance_m2_s2, []).append(cell)
        prices = [(f"{price:g}", *cells) for price, cells in by_price.items()]
        return {
            "criteria": table("rms, bias in mm/s, P in %", heads, map(cells_of, self.criteria)),
            "prices": table("rms in mm/s / switchings a pass", ("tolerance, m²/s²", *cases), prices),
        }

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated, and what each requirement took."""
        took = [f"{row.case}, {row.criterion}: {row.finding}" for row in self.criteria if row.finding is not None]
        stalls = [
            f"{r.case}, {r.criterion}: {100.0 * r.figures.stalled:.2f} % stall"
            for r in self.criteria
            if r.figures.stalled
        ]
        return (f"{self.passes} stratified passes a table, seed {self.seed}", *took, *stalls)


def cells_of(row: CriterionRow) -> tuple[str, ...]:
    """The cells of one criterion."""
    f = row.figures
    return (
        row.case, row.criterion, mm(f.rms_m_s, f.rms_ci95_m_s), around(row.ratio, row.ratio_ci95, 3),
        mm(f.bias_m_s, f.bias_ci95_m_s), *(around(share, ends, 2, 100.0) for share, ends in f.over),
        f"{f.switchings:.2f}", f"{mm(row.worst_rms_m_s, row.worst_ci95_m_s)}, {row.worst_factor:.1f}",
    )  # fmt: skip


def mm(value_m_s: float, ends_m_s: Sequence[float]) -> str:
    """A speed with its interval in mm/s."""
    return around(value_m_s, ends_m_s, 1, 1e3)
