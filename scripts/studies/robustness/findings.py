"""What the study `robustness` has found: plain values, and the tables of the page on robustness."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from scripts.studies.markdown_table import ABSENT, MarkdownTable, around, table
from scripts.studies.study import Findings
from synth.simulation.replicates import Interval

SHOWN_RATIO = 1.25
"""A parameter stands in the table of sensible ranges where it multiplies the rms of a case by more than this."""


@dataclass(frozen=True)
class OutcomeRow:
    """A table on one plant; `ratio`: rms / rms on the nominal plant, paired; rms of a table tuned for this plant."""

    name: str
    note: str
    rms_m_s: float
    rms_ci95_m_s: Interval
    ratio: float
    ratio_ci95: Interval
    bias_m_s: float
    bias_ci95_m_s: Interval
    overspeed: float
    overspeed_ci95: Interval
    stalled: float
    stalled_ci95: Interval
    switchings: float
    retuned_rms_m_s: float | None = None

    @property
    def cell(self) -> str:
        """'0.350 [0.345, 0.354] / 0.349': rms and that of a table tuned for this plant."""
        tuned = "" if self.retuned_rms_m_s is None else f" / {self.retuned_rms_m_s:.3f}"
        return around(self.rms_m_s, self.rms_ci95_m_s, 3) + tuned


@dataclass(frozen=True)
class EndsRow:
    """One parameter low and high (`values`), all else nominal; `nominal`: its value in the plant."""

    key: str
    name: str
    nominal: float
    values: tuple[float, float]
    less: OutcomeRow
    more: OutcomeRow

    @property
    def worst(self) -> OutcomeRow:
        """The end with the larger rms."""
        return max(self.less, self.more, key=lambda outcome: outcome.rms_m_s)

    @property
    def worst_value(self) -> float:
        """The value at that end."""
        return self.values[0 if self.worst is self.less else 1]


@dataclass(frozen=True)
class CaseRow:
    """One table on all plants."""

    case: str
    nominal: OutcomeRow
    sensible: tuple[EndsRow, ...]
    conditions: tuple[OutcomeRow, ...]


@dataclass(frozen=True)
class Robustness(Findings):
    """All cases."""

    config_sha256: str
    seed: int
    passes: int
    cases: tuple[CaseRow, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`conditions`, `ranges`."""
        return {"conditions": self.conditions(), "ranges": self.ranges()}

    @property
    def names(self) -> tuple[str, ...]:
        """The cases."""
        return tuple(case.case for case in self.cases)

    def conditions(self) -> MarkdownTable:
        """A row a named condition."""
        each = zip(*((case.nominal, *case.conditions) for case in self.cases), strict=True)
        rows = [
            (without_mass(found[0].name), *(one.cell for one in found),
             ", ".join(f"{100.0 * one.overspeed:.1f}" for one in found))
            for found in each
        ]  # fmt: skip
        title = "rms under named conditions, m/s [95 %] / of a table tuned for that plant; over-speed, %"
        return table(title, ("condition", *self.names, "over-speed"), rows)

    def ranges(self) -> MarkdownTable:
        """A row a parameter whose sensible range matters, at its worse end."""
        rows = [
            (name, *(f"{row.worst_value:.3g}: {row.worst.cell}" if row else ABSENT for row in found))
            for name, ratio, found in by_effect([case.sensible for case in self.cases])
            if ratio > SHOWN_RATIO
        ]
        title = "worse end of the library's sensible range: value, rms, m/s [95 %] / of a table tuned for that plant"
        return table(title, ("parameter", *self.names), rows)

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated, and stalls."""
        stalls = [
            f"{case.case}, {row.name}: {100.0 * row.stalled:.2f} % of the cuts stall"
            for case in self.cases for row in (case.nominal, *case.conditions) if row.stalled > 0.0
        ]  # fmt: skip
        return (
            f"{self.passes} stratified passes a plant, seed {self.seed}",
            *(stalls or ["no cut stalls under a named condition"]),
        )


def by_effect(cases: Sequence[Sequence[EndsRow]]) -> list[tuple[str, float, list[EndsRow | None]]]:
    """(name, largest rms ratio in any case, its row in each case) of every parameter, by that ratio.

    A row is None where the plant of a case has no such parameter.
    """
    found = []
    for key, name in {row.key: row.name for rows in cases for row in rows}.items():
        mine = [next((row for row in rows if row.key == key), None) for rows in cases]
        found.append((name, max(row.worst.ratio for row in mine if row is not None), mine))
    return sorted(found, key=lambda each: -each[1])


def without_mass(name: str) -> str:
    """'lightest cut of the category, 22 t' without the mass, which differs from case to case."""
    return name.partition(" category, ")[0] + " category" if " category, " in name else name
