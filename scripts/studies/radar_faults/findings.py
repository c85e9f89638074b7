"""What faults of the radar do to both controllers, and what becomes of wrong weights, as values and as tables."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from statistics import median

from scripts.studies.book import Measure
from scripts.studies.study import ABSENT, Findings, MarkdownTable, table

MATTERS, RMS_MATTERS = 1e-3, 1.02
"""A share that is so much larger, an rms that is so many times as large, is worse."""


@dataclass(frozen=True)
class Exits:
    """Shares of all cuts, and rms in m/s. Alarms are told of a pass that had one at any sample; None: no estimator."""

    stopped: Measure
    too_fast: Measure
    rms: Measure
    lost: Measure | None
    sensor: Measure | None
    category: Measure | None


@dataclass(frozen=True)
class FaultRow:
    """One fault in one case, without estimator and with it, on the same passes.

    `stopped_more`, `too_fast_more`: share with estimator less the share without; `rms_ratio`: with / without; paired.
    """

    fault: str
    before: Exits
    after: Exits
    stopped_more: Measure
    too_fast_more: Measure
    rms_ratio: Measure

    @property
    def worse(self) -> tuple[str, ...]:
        """In what the controller with estimator is worse: beyond the 95 % interval, and by what matters."""
        found = []
        for name, more, first, last in (
            ("stops", self.stopped_more, self.before.stopped, self.after.stopped),
            ("above the limit", self.too_fast_more, self.before.too_fast, self.after.too_fast),
        ):
            if more.ci95[0] > 0.0 and more.value > MATTERS:
                found.append(f"{name} {percent(first)} → {percent(last)} %")
        if self.rms_ratio.ci95[0] > 1.0 and self.rms_ratio.value > RMS_MATTERS:
            found.append(f"rms {self.before.rms.value:.3f} → {self.after.rms.value:.3f} m/s")
        return tuple(found)


@dataclass(frozen=True)
class CaseRow:
    """One case: a row for each fault, none first."""

    case: str
    faults: tuple[FaultRow, ...]


@dataclass(frozen=True)
class CategoryRow:
    """A cut to an exit speed, told to be of the class of a table: what becomes of it where that table stays, or not.

    `flagged`: share of cuts with the alarm LIGHTER or HEAVIER at the end of the pass under that table; `left`: share
    that other tables have taken over, where they may. rms in m/s, `too_fast` above the limit.
    """

    cut: str
    table: str
    plant: str
    flagged: Measure
    rms: Measure
    too_fast: Measure
    left: Measure
    rms_by_weight: Measure
    too_fast_by_weight: Measure


@dataclass(frozen=True)
class RadarFaults(Findings):
    """All of it; `own`: cuts under the table of their own class, on the plant as it is and on others."""

    config_sha256: str
    seed: int
    passes: int
    cases: tuple[CaseRow, ...]
    categories: tuple[CategoryRow, ...]
    own: tuple[CategoryRow, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`summary`: a row a fault; `cases`, `alarms`, `worse`; `category`, `category-rms`, `category-fast`, `own`."""
        tables, cuts = (tuple(dict.fromkeys(of(row) for row in self.categories)) for of in (table_name, cut_name))
        found = {(row.cut, row.table): row for row in self.categories}
        plants = tuple(dict.fromkeys(row.plant for row in self.own))
        owned = {(row.cut, row.plant): row for row in self.own}
        under = ("cut", *(f"table of {name}" for name in tables))

        def cells(text: Callable[[CategoryRow], str]) -> Iterator[tuple[str, ...]]:
            return ((cut, *(text(found[cut, name]) for name in tables)) for cut in cuts)

        false = ((cut, *(share(owned[cut, name].left) for name in plants)) for cut in cuts)
        return {
            "summary": self.summary(),
            "cases": self.by_case(),
            "alarms": self.alarms(),
            "worse": table("Where the estimator makes it worse", ("case", "fault", "what"), self.worse() or NOWHERE),
            "category": table(
                "Cuts with the alarm LIGHTER or HEAVIER at the end, % [95 %]", under, cells(lambda x: share(x.flagged))
            ),
            "category-rms": table("rms of the exit, m/s: the table stays → others take over", under, cells(both_rms)),
            "category-fast": table("Above the limit, %: the table stays → others take over", under, cells(both_fast)),
            "own": table("Cuts of the table's own class that others take over, % [95 %]", ("cut", *plants), false),
        }

    def summary(self) -> MarkdownTable:
        """The worst and the middle of all cases."""
        heads = ("fault", "stop in the retarder, worst, %", "above the limit, worst, %", "rms, median, m/s",
                 "rms, worst, m/s")  # fmt: skip
        rows = []
        for rows_of_fault in zip(*(case.faults for case in self.cases), strict=True):
            both = [[each.before for each in rows_of_fault], [each.after for each in rows_of_fault]]
            rows.append((
                rows_of_fault[0].fault,
                " → ".join(percent(max((x.stopped for x in exits), key=value)) for exits in both),
                " → ".join(percent(max((x.too_fast for x in exits), key=value)) for exits in both),
                " → ".join(f"{median(x.rms.value for x in exits):.3f}" for exits in both),
                " → ".join(f"{max(x.rms.value for x in exits):.3f}" for exits in both),
            ))  # fmt: skip
        return table("Without → with estimator, over all cases", heads, rows)

    def by_case(self) -> MarkdownTable:
        """Every figure with its interval."""
        heads = ("case", "fault", "stop in the retarder, %", "above the limit, %", "rms, m/s")
        rows = (
            (case.case, row.fault, *(f"{of(row.before)} → {of(row.after)}" for of in CELLS))
            for case in self.cases for row in case.faults
        )  # fmt: skip
        return table("Without → with estimator, each [95 %]", heads, rows)

    def alarms(self) -> MarkdownTable:
        """Least and largest share over the cases of cuts that have an alarm at some sample."""
        rows = []
        for rows_of_fault in zip(*(case.faults for case in self.cases), strict=True):
            exits = [each.after for each in rows_of_fault]
            rows.append((rows_of_fault[0].fault, *(span_of([of(x) for x in exits]) for of in ALARMS)))
        return table("Cuts with an alarm at some sample, least to most of the cases, %", ALARM_HEADS, rows)

    def worse(self) -> tuple[tuple[str, str, str], ...]:
        """Cells in which the controller with estimator is worse."""
        return tuple(
            (case.case, row.fault, "; ".join(row.worse)) for case in self.cases for row in case.faults if row.worse
        )

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        return (f"{self.passes} fresh stratified passes each, seed {self.seed}",)


NOWHERE = ((ABSENT, ABSENT, ABSENT),)
ALARM_HEADS = ("fault", "LOST", "SENSOR", "LIGHTER or HEAVIER")


def both_rms(row: CategoryRow) -> str:
    """'0.483 → 0.070 [0.068, 0.073]'."""
    return f"{row.rms.value:.3f} → {row.rms_by_weight.cell(3)}"


def both_fast(row: CategoryRow) -> str:
    """'25.5 → 1.20 [1.12, 1.29]'."""
    return f"{percent(row.too_fast)} → {share(row.too_fast_by_weight)}"


def value(measure: Measure) -> float:
    """The figure itself."""
    return measure.value


def cut_name(row: CategoryRow) -> str:
    """Of the cut."""
    return row.cut


def table_name(row: CategoryRow) -> str:
    """Of the class that the table is of."""
    return row.table


def percent(share: Measure) -> str:
    """'3.79'; a share that is not 0 never reads as 0."""
    return short(100.0 * share.value)


def short(number: float) -> str:
    """Per cent with as many digits as matter: '34.1', '3.79', '0.012', '0'."""
    if number == 0.0:
        return "0"
    if number >= 9.995:
        return f"{number:.1f}"
    return f"{number:.2f}" if number >= 0.0995 else f"{number:.1g}" if number < 0.00995 else f"{number:.2g}"


def share(measure: Measure) -> str:
    """'3.79 [3.50, 4.10]' in per cent."""
    low, high = (short(100.0 * end) for end in measure.ci95)
    return f"{percent(measure)} [{low}, {high}]"


def span_of(shares: list[Measure | None]) -> str:
    """'0.12 to 3.4'."""
    known = [100.0 * each.value for each in shares if each is not None]
    return f"{short(min(known))} to {short(max(known))}" if known else ABSENT


CELLS: tuple[Callable[[Exits], str], ...] = (
    lambda exits: share(exits.stopped),
    lambda exits: share(exits.too_fast),
    lambda exits: exits.rms.cell(3),
)
ALARMS: tuple[Callable[[Exits], Measure | None], ...] = (
    lambda exits: exits.lost,
    lambda exits: exits.sensor,
    lambda exits: exits.category,
)
