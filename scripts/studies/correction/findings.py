"""What the study of the on-line correction has found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from scripts.studies.markdown_table import MarkdownTable, around, table
from scripts.studies.study import Findings
from synth.simulation.replicates import Interval


@dataclass(frozen=True)
class Row:
    """One case on one plant.

    Ratios are rms with / without correction over all passes, and over the last quarter of every sequence; biases are of
    that quarter, `usable` the share of passes learnt from, `largest_m_s` the largest correction that was applied.
    """

    ageing: str
    stays: bool
    case: str
    plain_rms_m_s: float
    ratio: float
    ratio_ci95: Interval
    late_ratio: float
    late_ratio_ci95: Interval
    late_plain_bias_m_s: float
    late_bias_m_s: float
    usable: float
    largest_m_s: float


@dataclass(frozen=True)
class Corrected(Findings):
    """All cases on all plants."""

    config_sha256: str
    seed: int
    sequences: int
    passes: int
    limit_m_s: float
    memory_passes: float
    spread_m_s: float
    reading_m_s: float
    rows: tuple[Row, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`gain`: rms with / without; `bias`: what is left at the end."""
        gain = ("plant", "case", "rms without, m/s", "ratio [95 %]", "ratio in the last quarter [95 %]")
        bias = ("plant", "case", "bias without", "bias with", "largest correction", "learnt from")
        return {
            "gain": table(
                "rms with / without correction",
                gain,
                (
                    (r.ageing, r.case, f"{r.plain_rms_m_s:.4f}", around(r.ratio, r.ratio_ci95, 3),
                     around(r.late_ratio, r.late_ratio_ci95, 3))
                    for r in self.rows
                ),
            ),
            "bias": table(
                "Mean exit error in the last quarter, m/s",
                bias,
                (
                    (r.ageing, r.case, f"{r.late_plain_bias_m_s:+.4f}", f"{r.late_bias_m_s:+.4f}",
                     f"{r.largest_m_s:.3f}", f"{100.0 * r.usable:.0f} %")
                    for r in self.rows
                ),
            ),
        }  # fmt: skip

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        return (
            f"{self.sequences} independent sequences of {self.passes} passes for each row, seed {self.seed}; memory "
            f"{self.memory_passes:g} passes, spread {self.spread_m_s:g} m/s, exits read to {self.reading_m_s:g} m/s",
        )

    def faults(self) -> tuple[str, ...]:
        """Rows where the correction is worse than none on a plant that stays, or beyond its limit."""
        worse = [
            f"{row.case}: on a plant that stays the rms with correction is {row.ratio:.4f} of that without, and the "
            f"interval {row.ratio_ci95[0]:.4f} to {row.ratio_ci95[1]:.4f} lies above 1"
            for row in self.rows
            if row.stays and row.ratio_ci95[0] > 1.0
        ]
        # The limit is applied in float32.
        beyond = [
            f"{row.case}, {row.ageing}: a correction of {row.largest_m_s} m/s is beyond the limit"
            for row in self.rows
            if row.largest_m_s > self.limit_m_s + 1e-7
        ]
        return (*worse, *beyond)
