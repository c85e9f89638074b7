"""Whether a book of tables keeps the limits that its configuration sets, case by case, with reasons; and what a tune
has come to: the book, what its passes say of the limits, and the files that hold its tables.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Generic

from synth.frame.command import Limit
from synth.frame.exhibits import File
from synth.frame.printed_numbers import counted
from synth.retarder.case_result import CaseResult
from synth.retarder.comparison.measured import Judgement, interval_text, judgement
from synth.retarder.configuration.settings import AcceptanceSettings
from synth.retarder.failed_case import FailedCase, told_together
from synth.retarder.tune import Book
from synth.retarder.tuned_case import Case, TunedCase
from synth.simulation.exit_statistics import UnavoidableError
from synth.simulation.replicates import share_of
from tuning_tables import Decisions


@dataclass(frozen=True)
class CaseVerdict:
    """One case: `judgement` of its table, whether it is feasible or not.

    `obstacle`: what makes the case infeasible, '' for a feasible one. Where the table misses an rms that its position
    does not forbid, `within_reach` says what is known of that, and `advice` what to change.
    """

    name: str
    obstacle: str
    judgement: Judgement
    within_reach: str = ""
    advice: tuple[str, ...] = ()

    @property
    def phrases(self) -> tuple[str, ...]:
        """What is missed or undecided, and what is known of the rms that the table does not reach."""
        return (*self.judgement.phrases, *filter(None, [self.within_reach]))

    @property
    def feasible(self) -> bool:
        """The position does not forbid the limit of the rms, or the passes cannot tell."""
        return not self.obstacle

    @property
    def word(self) -> str:
        """'accepted', 'missed', 'not decidable' or 'infeasible'."""
        return self.judgement.word if self.feasible else "infeasible"


def judged(cases: Sequence[TunedCase], limits: AcceptanceSettings) -> tuple[CaseVerdict, ...]:
    """What the simulated passes of each case say of `limits`."""
    return tuple(judge_case(case, limits) for case in cases)


def limits_of(
    verdicts: Sequence[CaseVerdict],
    cases: Sequence[TunedCase],
    limits: AcceptanceSettings,
    failed: Sequence[FailedCase],
) -> Iterator[Limit]:
    """A limit for each case that does not keep all of `limits`, or one that tells the worst case.

    `verdicts`: on these `cases`; `failed`: cases without a table. Infeasible cases do not count.
    """
    if failed:
        every = counted(len(verdicts) + len(failed), "case")
        yield Limit(f"there is no table for {len(failed)} of {every} ({told_together(failed)})", False)
    feasible = [(case.statistics, verdict) for case, verdict in zip(cases, verdicts, strict=True) if verdict.feasible]
    if not feasible:
        yield Limit("no case is feasible, so there is nothing to accept", False)
        return
    open_ones = [verdict for _, verdict in feasible if verdict.word != "accepted"]
    for verdict in open_ones:
        yield Limit(f"{verdict.name}: {', '.join(verdict.phrases)}", False if verdict.judgement.missed else None)
    if open_ones:
        return
    worst, of_worst = max(feasible, key=lambda pair: pair[0].rms_m_s)
    yield Limit(
        f"the limits are kept in {counted(len(feasible), 'feasible case')}; the worst rms is {worst.rms_m_s:.4f} "
        f"{interval_text(worst.rms_ci95_m_s)} m/s ({of_worst.name}) where {limits.rms_m_s:g} m/s are allowed",
        True,
    )


def advice_of(verdicts: Sequence[CaseVerdict]) -> str:
    """What to change where limits are missed or undecided, in a sentence; nothing where there is no need."""
    feasible = [each for each in verdicts if each.feasible]
    ways = list(dict.fromkeys(way for each in feasible for way in each.advice))
    if any(each.word == "not decidable" for each in feasible):
        ways.append("a larger validation.passes where a limit is not decidable")
    return f"Try {', '.join(ways)}." if ways else ""


def judge_case(case: TunedCase, limits: AcceptanceSettings) -> CaseVerdict:
    """The verdict on one case, from the passes that its table was simulated on.

    A case is infeasible if its unavoidable error makes the rms miss the limit, with all of the 95 % interval.
    """
    error = case.exit_speeds_m_s.astype(float) - case.target_speed_m_s
    over = share_of(error > limits.overspeed_margin_m_s, case.exit_weight)
    found = judgement(case.statistics, over, case.table.predicted, limits)
    judged = verdict_within(case.name, found, case.unavoidable, limits)
    missed = judged.word == "missed" and case.statistics.rms_ci95_m_s[0] > limits.rms_m_s
    if missed and isinstance(case, CaseResult):
        return replace(judged, within_reach=within_reach(case, limits.rms_m_s), advice=what_to_change(case))
    return judged


def verdict_within(
    name: str, found: Judgement, unavoidable: UnavoidableError, limits: AcceptanceSettings
) -> CaseVerdict:
    """The verdict on a case of which `found` was said, where no table avoids the error `unavoidable`."""
    if unavoidable.undecided(limits.rms_m_s) and found.missed:
        # What is missed would not count in an infeasible case, and that cannot be told.
        unsure = f"{unavoidable_text(unavoidable)}, too near to the limit to tell whether the case is feasible"
        found = Judgement((), (*found.missed, *found.undecided, unsure))
    return CaseVerdict(name, unavoidable.obstacle if unavoidable.forbids(limits.rms_m_s) else "", found)


def within_reach(case: CaseResult, limit_m_s: float) -> str:
    """What is known of the rms `limit_m_s` that a table misses and its position does not forbid.

    Where a tuned law keeps it, the position is known to be able to.
    """
    best = case.comparison.best_baseline
    if best is not None and best.statistics.rms_ci95_m_s[1] <= limit_m_s:
        return f"which the position can: a tuned {best.name} has {best.statistics.rms_m_s:.4f} m/s"
    return f"which the position does not forbid: {unavoidable_text(case.unavoidable)}"


def what_to_change(case: CaseResult) -> tuple[str, ...]:
    """What may help where a table misses an rms that its position does not forbid, the likeliest first."""
    ways = []
    if case.estimate is None:
        ways.append("regulator.estimator = true")
    if case.table.decisions is Decisions.AT_REST:
        ways.append('regulator.commands = "any_time"')
    return (*ways, "another fit.degree or another target")


def unavoidable_text(error: UnavoidableError) -> str:
    """The bound of every regulator's rms, with its interval."""
    return f"the rms that no regulator avoids is {error.rms_m_s:.4f} {interval_text(error.rms_ci95_m_s)} m/s"


@dataclass(frozen=True)
class FoundBook(Generic[Case]):
    """`verdicts`: on the cases of `book`, in its order; `files`: the tables together, in every form.

    `no_st`: why there is no Structured Text among them, '' where there is, or where none is written.
    """

    book: Book[Case]
    verdicts: tuple[CaseVerdict, ...]
    files: tuple[File, ...]
    no_st: str = ""

    @property
    def judged(self) -> Iterator[tuple[Case, CaseVerdict]]:
        """Each case with its verdict."""
        return zip(self.book.cases, self.verdicts, strict=True)

    @property
    def feasible(self) -> tuple[Case, ...]:
        """The cases whose position does not forbid the limit of the rms."""
        return tuple(case for case, verdict in self.judged if verdict.feasible)
