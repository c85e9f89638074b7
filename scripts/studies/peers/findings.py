"""What the study `peers` has found: tables and their peers on the same passes, with equal permissions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from scripts.studies.study import ABSENT, Findings, MarkdownTable, around, span, table
from synth.simulation.replicates import Interval

AT_REST, AT_ANY_TIME = "at rest", "at any time"
PRICED, FREE = "priced", "free"

TABLE, TABLE_WITHOUT, PREDICTIVE = "table, estimator", "table, measured speed", "predictive"

AS_GOOD = 1.05
"""Claimed: a table at rest has at most so much of the rms of the predictive controller; at any time, less than all."""

HEADS = (
    "case", "controller", "rms, mm/s [95 %]", "/ table [95 %]", "99 % of \\|error\\|, mm/s", "commands", "time, s",
    "stalled, %", "criterion / table",
)  # fmt: skip


@dataclass(frozen=True)
class Figures:
    """One controller. `ratio`: its rms / that of the table with estimator, of the same permission and price.

    `parameters`: the numbers found by tuning, none for a table. `p99_m_s`: quantile of |error|.
    """

    name: str
    rms_m_s: float
    rms_ci95_m_s: Interval
    ratio: float
    ratio_ci95: Interval
    p99_m_s: float
    commands: float
    time_s: float
    stalled: float
    parameters: Mapping[str, float]


@dataclass(frozen=True)
class Day:
    """A day with this much of the friction: rms of the table with estimator, rms of the predictive one / that."""

    factor: float
    table_rms_m_s: float
    ratio: float
    ratio_ci95: Interval


@dataclass(frozen=True)
class Contest:
    """Controllers of one case with one permission, a command priced as in the table or free; the table comes first.

    `price_m2_s2`: of a command, for the peers; `days`: both as they are, on other days than they were made for.
    """

    case: str
    permission: str
    price: str
    price_m2_s2: float
    figures: tuple[Figures, ...]
    days: tuple[Day, ...] = ()

    @property
    def table(self) -> Figures:
        """The table with estimator."""
        return self.figures[0]

    @property
    def predictive(self) -> Figures:
        """The predictive controller."""
        return next(each for each in self.figures if each.name == PREDICTIVE)

    @property
    def rivals(self) -> tuple[Figures, ...]:
        """All that are no tables."""
        return tuple(each for each in self.figures if each.parameters)

    def criterion(self, each: Figures) -> float:
        """What `each` costs: mean square of the error, and price of its commands; over that of the table."""
        cost, of_table = (figures.rms_m_s**2 + self.price_m2_s2 * figures.commands for figures in (each, self.table))
        return cost / of_table


@dataclass(frozen=True)
class Peers(Findings):
    """All cases; `evaluations`: the most that tuning a peer took."""

    config_sha256: str
    seed: int
    passes: int
    tuning_passes: int
    evaluations: int
    contests: tuple[Contest, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`at-rest-priced` and so on: a row a controller; `summary`: a row for each of these; `days`; `numbers`."""
        found = {}
        for permission, price in self.kinds():
            title = f"commands {permission}, {price}"
            found[f"{permission} {price}".replace(" ", "-")] = table(title, HEADS, rows_of(self.of(permission, price)))
        found["summary"] = table("rms of the table / rms of its peers", SUMMARY, map(self.summary, self.kinds()))
        found["days"] = table(
            "rms of the predictive controller / rms of the table on other days", DAYS, day_rows(self.contests)
        )
        found["numbers"] = table("what tuning found for the predictive controller", NUMBERS, number_rows(self.contests))
        return found

    def kinds(self) -> tuple[tuple[str, str], ...]:
        """Permissions and prices in the order of the cases."""
        return tuple(dict.fromkeys((each.permission, each.price) for each in self.contests))

    def of(self, permission: str, price: str) -> tuple[Contest, ...]:
        """The contests of one kind."""
        return tuple(each for each in self.contests if (each.permission, each.price) == (permission, price))

    def summary(self, kind: tuple[str, str]) -> tuple[str, ...]:
        """The cells of one kind."""
        contests = self.of(*kind)
        ratios = sorted(1.0 / each.predictive.ratio for each in contests)
        costs = sorted(1.0 / each.criterion(each.predictive) for each in contests)
        commands = sorted(each.table.commands / each.predictive.commands for each in contests)
        longer = sorted(each.table.time_s - each.predictive.time_s for each in contests)
        counts = (f"{count(contests)} of {len(contests)}" for count in (as_good, better, beaten))
        return (
            *kind, f"{ratios[0]:.2f} to {ratios[-1]:.2f}", f"{costs[0]:.2f} to {costs[-1]:.2f}", *counts,
            f"{commands[0]:.2f} to {commands[-1]:.2f}", f"{longer[0]:+.1f} to {longer[-1]:+.1f}",
        )  # fmt: skip

    def sentences(self) -> tuple[str, ...]:
        """Whether the claims hold, and how much was simulated."""
        told = []
        for permission, price in self.kinds():
            contests = self.of(permission, price)
            good, count = (as_good if permission == AT_REST else beaten)(contests), len(contests)
            what = (
                f"has at most {AS_GOOD:g} of the rms of the predictive controller"
                if permission == AT_REST
                else "has less rms than every peer"
            )
            told.append(f"commands {permission}, {price}: the table with estimator {what} in {good} of {count} cases")
        told.append(f"{self.passes} stratified passes a controller, seed {self.seed}")
        told.append(f"peers tuned in at most {self.evaluations} evaluations on {self.tuning_passes} other passes")
        return tuple(told)


SUMMARY = (
    "commands", "a command is", "rms of the table / predictive", "criterion of the table / predictive",
    f"at most {AS_GOOD:g}", "less beyond the interval", "less than every peer", "commands of the table / predictive",
    "longer in the position, s",
)  # fmt: skip


def as_good(contests: Sequence[Contest]) -> int:
    """In how many the table has at most `AS_GOOD` of the rms of the predictive controller."""
    return sum(each.predictive.ratio * AS_GOOD >= 1.0 for each in contests)


def better(contests: Sequence[Contest]) -> int:
    """In how many the table has less rms than the predictive controller, beyond the interval."""
    return sum(each.predictive.ratio_ci95[0] > 1.0 for each in contests)


def beaten(contests: Sequence[Contest]) -> int:
    """In how many the table has less rms than every peer."""
    return sum(all(rival.ratio > 1.0 for rival in each.rivals) for each in contests)


def rows_of(contests: Sequence[Contest]) -> Iterator[tuple[str, ...]]:
    """A row for each controller of each case."""
    for contest in contests:
        for each in contest.figures:
            ratio = ABSENT if each is contest.table else f"{each.ratio:.2f} {span(each.ratio_ci95, 2)}"
            yield (
                contest.case, each.name,
                around(each.rms_m_s, each.rms_ci95_m_s, 1, 1e3), ratio, f"{1e3 * each.p99_m_s:.0f}",
                f"{each.commands:.1f}", f"{each.time_s:.1f}", f"{100.0 * each.stalled:.2f}",
                ABSENT if each is contest.table else f"{contest.criterion(each):.2f}",
            )  # fmt: skip


NUMBERS = ("case", "commands", "a command is", "horizon, s", "p̂ / highest", "shift, mm/s", "price, m²/s²")


def number_rows(contests: Sequence[Contest]) -> Iterator[tuple[str, ...]]:
    """A row for each predictive controller."""
    for contest in contests:
        found = contest.predictive.parameters
        yield (
            contest.case, contest.permission, contest.price, f"{found['horizon_s']:.2f}", f"{found['held_share']:.3f}",
            f"{1e3 * found['shift_m_s']:+.1f}", f"{found['price_m2_s2']:.3f}",
        )  # fmt: skip


DAYS = ("case", "commands", "a command is", "friction ×", "rms of the table, mm/s", "predictive / table [95 %]")


def day_rows(contests: Sequence[Contest]) -> Iterator[tuple[str, ...]]:
    """A row for each day of each contest."""
    for contest in contests:
        for day in contest.days:
            yield (
                contest.case, contest.permission, contest.price, f"{day.factor:g}", f"{1e3 * day.table_rms_m_s:.1f}",
                f"{day.ratio:.2f} {span(day.ratio_ci95, 2)}",
            )  # fmt: skip
