"""What the study `watch` finds: delays and names of drifts, and false alarms."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from scripts.studies.study import Findings, Interval, MarkdownTable, span, table

WANTED_SHARE = 0.95


@dataclass(frozen=True)
class Found:
    """Repetitions of one change: passes from it to the alarm and to the name, median and 90 % quantile; shares.
    `in_yard`: passes to the alarm with the limit of a yard, in which nothing else is changed.

    `right`: the name was that of the change; `wrong`: another one; `early`: the alarm came before the change. The rest
    was not decided. Shares are of the repetitions that were not early.
    """

    change: str
    gauge: bool
    repetitions: int
    early: int
    alarm: tuple[float, float]
    in_yard: tuple[float, float]
    named: tuple[float, float]
    right: float
    right_ci95: Interval
    wrong: float


@dataclass(frozen=True)
class FalseAlarms:
    """Of passes in order: `alarms` among `passes`, the 95 % interval of their rate (Poisson), and what is proved of it:
    one in `run_length` at most. `of`: one position, or a yard of them, whose passes count together."""

    of: str
    run_length: float
    gauge: bool
    charts: int
    limit: float
    passes: int
    alarms: int
    rate_ci95: Interval


@dataclass(frozen=True)
class Ranked:
    """A line of the list of repairs: rank (0 for a fault that is not on it), position, fault, what was named, whether
    that is right, passes from its beginning to the alarm, and what it costs an hour, each with its interval."""

    rank: int
    position: str
    change: str
    named: str
    right: bool
    passes: int
    overspeeds: tuple[float, float, float] | None
    cars: tuple[float, float, float] | None
    weight: tuple[float, float, float] | None
    is_ahead: bool | None


@dataclass(frozen=True)
class Watched(Findings):
    """All of it."""

    config_sha256: str
    seed: int
    passes: int
    changed_passes: int
    found: tuple[Found, ...]
    false_alarms: tuple[FalseAlarms, ...]
    night_positions: int
    night_passes: int
    night: tuple[Ranked, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`drifts`: a row a change; `false-alarms`: with and without gauge; `night`: the list of repairs of a yard."""
        heads = ("change", "gauge", "passes to the alarm: median, 90 %", "the same in a yard",
                 "to its name: median, 90 %", "named rightly, % [95 %]", "wrongly, %")  # fmt: skip
        rows = [
            (each.change, word(each.gauge), pair(each.alarm), pair(each.in_yard), pair(each.named),
             f"{100.0 * each.right:.1f} {span(each.right_ci95, 1, 100.0)}", f"{100.0 * each.wrong:.1f}")
            for each in self.found
        ]  # fmt: skip
        alarm_heads = ("of", "gauge", "charts of a position", "limit", "passes in order", "false alarms",
                       "in so many passes", "false alarms in these [95 %]", "proved, at most")  # fmt: skip
        alarms = [
            (each.of, word(each.gauge), str(each.charts), f"{each.limit:.1f}", str(each.passes), str(each.alarms),
             f"{each.run_length:.0f}",
             f"{each.run_length * each.alarms / each.passes:.2f} {span(each.rate_ci95, 2, each.run_length)}", "1")
            for each in self.false_alarms
        ]  # fmt: skip
        night_heads = ("rank", "position", "fault", "named", "rightly", "passes to the alarm",
                       "more over-speed couplings, 1/h", "cars lost, 1/h", "all that is worse, cars/h",
                       "ahead for sure")  # fmt: skip
        night = [
            (str(each.rank or "–"), each.position, each.change, each.named, word(each.right), str(each.passes or "–"),
             told(each.overspeeds), told(each.cars), told(each.weight),
             "–" if each.is_ahead is None else word(each.is_ahead))
            for each in self.night
        ]  # fmt: skip
        return {
            "drifts": table("Drifts found and named", heads, rows),
            "false-alarms": table("False alarms of all charts together", alarm_heads, alarms),
            "night": table("What to repair first, after a night with every fault", night_heads, night),
        }

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        return (
            f"{self.passes} passes in order and {self.changed_passes} of each change, seed {self.seed}; repetitions "
            "draw from them with replacement",
            f"the night: {self.night_positions} positions, {self.night_passes} passes each, with a gauge; faults begin "
            "after half of these",
        )

    def faults(self) -> tuple[str, ...]:
        """Too many false alarms, or too few right names."""
        often = [
            f"{each.run_length * each.rate_ci95[0]:.2f} false alarms in {each.run_length:.0f} passes or more "
            f"(of {each.of}, gauge: {word(each.gauge)})"
            for each in self.false_alarms
            if each.rate_ci95[0] * each.run_length > 1.0
        ]
        rarely = [
            f"{each.change} (gauge: {word(each.gauge)}) is named in {100.0 * each.right:.1f} % only"
            for each in self.found
            if each.right_ci95[1] < WANTED_SHARE
        ]
        return (*often, *rarely)


def word(value: bool) -> str:
    """In a word."""
    return "yes" if value else "no"


def told(value: tuple[float, float, float] | None) -> str:
    """'1.52 [1.31, 1.73]'."""
    return "–" if value is None else f"{value[0]:.2f} {span(value[1:], 2)}"


def pair(values: tuple[float, float]) -> str:
    """'11, 13'."""
    return f"{values[0]:.0f}, {values[1]:.0f}"
