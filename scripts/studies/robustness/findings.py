"""What the study `robustness` has found: plain values, and the tables of the page on robustness."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from scripts.studies.markdown_table import ABSENT, MarkdownTable, around, table
from scripts.studies.study import Findings
from synth.simulation.exit_statistics import clopper_pearson
from synth.simulation.replicates import Interval

SHOWN_RATIO = 1.25
"""A parameter stands in the table of sensible ranges where it multiplies the rms of a case by more than this."""

SHOWN_HALVES = 8
"""Parameters in the table of halves."""

CLIFF = 2.0
"""A step of a sweep that multiplies the rms by more than this is called a cliff."""


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
    retuned_ci95_m_s: Interval | None = None

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
    assumed: bool
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
class SweepRow:
    """One parameter over relative errors; where the rms passes the limit; (error, rms) of tables tuned for there."""

    key: str
    name: str
    relative: tuple[float, ...]
    rms_m_s: tuple[float, ...]
    steepest: float
    tolerated: tuple[float | None, float | None]
    retuned: tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class TogetherRow:
    """All assumed parameters off at once: rms and shares at the points, rank correlation of the rms with each."""

    span: float
    passes: int
    names: tuple[str, ...]
    rank_correlation: tuple[float, ...]
    rms_m_s: tuple[float, ...]
    overspeed: tuple[float, ...]
    stalled: tuple[float, ...]

    def share_within(self, limit_m_s: float) -> tuple[float, Interval]:
        """Share of the points whose rms is within the limit, and its 95 % interval."""
        hits, n = sum(rms <= limit_m_s for rms in self.rms_m_s), len(self.rms_m_s)
        return hits / n, clopper_pearson(hits, n)

    def quantile_m_s(self, share: float) -> tuple[float, Interval]:
        """Quantile of the rms over the points, and its 95 % interval from order statistics."""
        from scipy.stats import binom  # start-up: scipy only where it is needed

        ordered, n = sorted(self.rms_m_s), len(self.rms_m_s)
        low, high = (int(binom.ppf(tail, n, share)) for tail in (0.025, 0.975))
        return float(np.quantile(ordered, share)), (ordered[max(low - 1, 0)], ordered[min(high, n - 1)])

    @property
    def leading(self) -> tuple[str, ...]:
        """'K +0.42': the parameters whose rank correlation stands out of chance, the strongest first."""
        chance = 1.96 / max(len(self.rms_m_s) - 1, 1) ** 0.5
        order = sorted(zip(self.names, self.rank_correlation, strict=True), key=lambda each: -abs(each[1]))
        return tuple(f"{name} {value:+.2f}" for name, value in order if abs(value) > chance)


@dataclass(frozen=True)
class CaseRow:
    """One table on all plants."""

    case: str
    nominal: OutcomeRow
    halves: tuple[EndsRow, ...]
    sensible: tuple[EndsRow, ...]
    conditions: tuple[OutcomeRow, ...]
    sweeps: tuple[SweepRow, ...]
    together: tuple[TogetherRow, ...]


@dataclass(frozen=True)
class Robustness(Findings):
    """All cases; `left_out`: assumed values that are not changed, and why."""

    config_sha256: str
    seed: int
    passes: int
    limit_m_s: float
    left_out: dict[str, str]
    cases: tuple[CaseRow, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`conditions`, `ranges`, `halves`, `tolerated`, `together`."""
        return {
            "conditions": self.conditions(),
            "ranges": self.ranges(),
            "halves": self.halves(),
            "tolerated": self.tolerated(),
            "together": self.together(),
        }

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

    def halves(self) -> MarkdownTable:
        """A row a parameter at −50 % and +50 %."""
        rows = [
            (name, *(f"{row.less.rms_m_s:.3f} / {row.more.rms_m_s:.3f}" if row else ABSENT for row in found))
            for name, _, found in by_effect([case.halves for case in self.cases])[:SHOWN_HALVES]
        ]
        return table("rms at −50 % / at +50 % of one parameter, m/s", ("parameter", *self.names), rows)

    def tolerated(self) -> MarkdownTable:
        """A row a swept parameter: where the rms passes the limit, and the largest factor between points."""
        rows = []
        for at, first in enumerate(self.cases[0].sweeps):
            swept = [case.sweeps[at] for case in self.cases]
            rows.append((first.name, *map(crossed, swept), f"{max(each.steepest for each in swept):.2f}"))
        heads = ("parameter", *self.names, "largest factor of a step")
        return table(f"error of one parameter at which the rms passes {self.limit_m_s:g} m/s", heads, rows)

    def together(self) -> MarkdownTable:
        """A row a case and span."""
        heads = ("all assumed parameters within", "case", f"within {self.limit_m_s:g} m/s, % [95 %]", "median rms",
                 "95 % quantile", "worst stalls, %", "strongest rank correlations")  # fmt: skip
        rows: list[tuple[str, ...]] = []
        for case in self.cases:
            for drawn in case.together:
                share, ends = drawn.share_within(self.limit_m_s)
                rows.append(
                    (f"±{100.0 * drawn.span:.0f} %", case.case, around(share, ends, 0, 100.0),
                     around(*drawn.quantile_m_s(0.5), 3), around(*drawn.quantile_m_s(0.95), 2),
                     f"{100.0 * max(drawn.stalled):.2g}", ", ".join(drawn.leading[:4])),
                )  # fmt: skip
        rows.sort(key=lambda row: row[0])
        return table("all assumed parameters wrong at once", heads, rows)

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated, cliffs, stalls."""
        steepest = max(row.steepest for case in self.cases for row in case.sweeps)
        stalls = [
            f"{case.case}, {row.name}: {100.0 * row.stalled:.2f} % of the cuts stall"
            for case in self.cases for row in (case.nominal, *case.conditions) if row.stalled > 0.0
        ]  # fmt: skip
        points = {len(drawn.rms_m_s) for case in self.cases for drawn in case.together}
        return (
            f"{self.passes} stratified passes a plant, seed {self.seed}; {max(points)} points of a Latin hypercube, "
            f"{self.cases[0].together[0].passes} passes each",
            f"the steepest step of a sweep multiplies the rms by {steepest:.2f}: "
            + ("a cliff" if steepest > CLIFF else "no cliff"),
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


def crossed(swept: SweepRow) -> str:
    """'−15 %': where the limit is passed below, and above if it is there."""
    down, up = (None if x is None else f"{100.0 * x:+.0f} %".replace("-", "−") for x in swept.tolerated)
    return ", ".join(each for each in (down, up) if each) or "never"
