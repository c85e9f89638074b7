"""What the study `watch` finds: delays and names of drifts, and false alarms."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from scripts.studies.markdown_table import Interval, MarkdownTable, span, table
from scripts.studies.study import Findings

WANTED_SHARE = 0.95
WANTED_RATE = 1e-4


@dataclass(frozen=True)
class Found:
    """Repetitions of one change: passes from it to the alarm and to the name, median and 90 % quantile; shares.

    `right`: the name was that of the change; `wrong`: another one; `early`: the alarm came before the change. The rest
    was not decided. Shares are of the repetitions that were not early.
    """

    change: str
    gauge: bool
    repetitions: int
    early: int
    alarm: tuple[float, float]
    named: tuple[float, float]
    right: float
    right_ci95: Interval
    wrong: float


@dataclass(frozen=True)
class FalseAlarms:
    """Of passes in order: `alarms` among `passes`, the 95 % interval of their rate (Poisson), what is proved of it."""

    gauge: bool
    charts: int
    limit: float
    passes: int
    alarms: int
    rate_ci95: Interval


@dataclass(frozen=True)
class Watched(Findings):
    """All of it."""

    config_sha256: str
    seed: int
    passes: int
    changed_passes: int
    found: tuple[Found, ...]
    false_alarms: tuple[FalseAlarms, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`drifts`: a row a change; `false-alarms`: with and without gauge."""
        heads = ("change", "gauge", "passes to the alarm: median, 90 %", "to its name: median, 90 %",
                 "named rightly, % [95 %]", "wrongly, %")  # fmt: skip
        rows = [
            (each.change, word(each.gauge), pair(each.alarm), pair(each.named),
             f"{100.0 * each.right:.1f} {span(each.right_ci95, 1, 100.0)}", f"{100.0 * each.wrong:.1f}")
            for each in self.found
        ]  # fmt: skip
        alarm_heads = ("gauge", "charts", "limit", "passes in order", "false alarms", "in 10 000 passes [95 %]",
                       "proved, at most")  # fmt: skip
        alarms = [
            (word(each.gauge), str(each.charts), f"{each.limit:.1f}", str(each.passes), str(each.alarms),
             f"{1e4 * each.alarms / each.passes:.2f} {span(each.rate_ci95, 2, 1e4)}", "1")
            for each in self.false_alarms
        ]  # fmt: skip
        return {
            "drifts": table("Drifts found and named", heads, rows),
            "false-alarms": table("False alarms of all charts together", alarm_heads, alarms),
        }

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        return (
            f"{self.passes} passes in order and {self.changed_passes} of each change, seed {self.seed}; repetitions "
            "draw from them with replacement",
        )

    def faults(self) -> tuple[str, ...]:
        """Too many false alarms, or too few right names."""
        often = [
            f"{1e4 * each.rate_ci95[0]:.2f} false alarms in 10 000 passes or more (gauge: {word(each.gauge)})"
            for each in self.false_alarms
            if each.rate_ci95[0] > WANTED_RATE
        ]
        rarely = [
            f"{each.change} (gauge: {word(each.gauge)}) is named in {100.0 * each.right:.1f} % only"
            for each in self.found
            if each.right_ci95[1] < WANTED_SHARE
        ]
        return (*often, *rarely)


def word(gauge: bool) -> str:
    """Whether there is one."""
    return "yes" if gauge else "no"


def pair(values: tuple[float, float]) -> str:
    """'11, 13'."""
    return f"{values[0]:.0f}, {values[1]:.0f}"
