"""Whether a book of tables keeps the limits that its configuration sets: the verdict, case by case, with reasons."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from synth.book.case_names import case_name
from synth.book.case_result import CaseResult
from synth.book.failed_case import FailedCase, told_together
from synth.book.judgement import Judgement, interval_text, judgement
from synth.book.off_nominal.worst import worst_of
from synth.configuration.settings import AcceptanceSettings
from synth.frame.printed_numbers import counted
from synth.simulation.exit_statistics import ExitStatistics
from synth.simulation.replicates import share_of
from synth.simulation.unavoidable_error import UnavoidableError
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


@dataclass(frozen=True)
class Verdict:
    """`accepted`: no case has `failed`, there are feasible cases, and all of them keep every limit; `sentence` says it
    in words.

    Infeasible cases do not count, but the sentence names them.
    """

    accepted: bool
    sentence: str
    cases: tuple[CaseVerdict, ...]
    failed: tuple[FailedCase, ...] = ()


def judge(cases: Sequence[CaseResult], limits: AcceptanceSettings, failed: tuple[FailedCase, ...] = ()) -> Verdict:
    """The verdict on the simulated passes of `cases`, where other cases have `failed`.

    Its sentence ends with the worst of the feasible ones off nominal, which the verdict does not depend on.
    """
    judged = tuple(judge_case(case, limits) for case in cases)
    verdict = verdict_on(judged, [case.comparison.table.statistics for case in cases], limits, failed)
    worst = worst_of([case for case, each in zip(cases, judged, strict=True) if each.feasible])
    return verdict if worst is None else replace(verdict, sentence=f"{verdict.sentence}; {worst.told}")


def verdict_on(
    judged: tuple[CaseVerdict, ...],
    found: Sequence[ExitStatistics],
    limits: AcceptanceSettings,
    failed: tuple[FailedCase, ...],
) -> Verdict:
    """What the verdicts on all cases, of which `found` was simulated, come to where others have `failed`."""
    feasible = [(each, verdict) for each, verdict in zip(found, judged, strict=True) if verdict.feasible]
    bad = [verdict for _, verdict in feasible if verdict.judgement.missed]
    open_ones = [verdict for _, verdict in feasible if verdict.judgement.word == "not decidable"]
    if not feasible:
        sentence = "no case is feasible, so there is nothing to accept"
    elif bad:
        sentence = f"a limit is missed in {len(bad)} of {counted(len(feasible), 'feasible case')} ({told(bad)})"
    elif open_ones:
        sentence = (
            f"no limit is missed, but the passes are too few to decide {len(open_ones)} of "
            f"{counted(len(feasible), 'feasible case')} ({told(open_ones)}); raise validation.passes"
        )
    else:
        worst, of_worst = max(feasible, key=lambda pair: pair[0].rms_m_s)
        sentence = (
            f"the limits are kept in {counted(len(feasible), 'feasible case')}; the worst rms is {worst.rms_m_s:.4f} "
            f"{interval_text(worst.rms_ci95_m_s)} m/s ({of_worst.name}) where {limits.rms_m_s:g} m/s are allowed"
        )
    outside = [f"{verdict.name} ({verdict.obstacle})" for verdict in judged if not verdict.feasible]
    if outside:
        sentence += f"; infeasible and outside this verdict: {', '.join(outside)}"
    if failed:
        every = counted(len(judged) + len(failed), "case")
        sentence = (
            f"there is no table for {len(failed)} of {every} ({told_together(failed)}); of the others: {sentence}"
        )
    return Verdict(bool(feasible) and not bad and not open_ones and not failed, sentence, judged, failed)


def told(verdicts: Sequence[CaseVerdict]) -> str:
    """Cases with what is missed or undecided in them, and what to change in any of them."""
    cases = "; ".join(f"{each.name}: {', '.join(each.phrases)}" for each in verdicts)
    ways = tuple(dict.fromkeys(way for each in verdicts for way in each.advice))
    return f"{cases}; try {', '.join(ways)}" if ways else cases


def judge_case(case: CaseResult, limits: AcceptanceSettings) -> CaseVerdict:
    """The verdict on one case, from the passes that its table was simulated on."""
    error = case.exit_speeds_m_s.astype(float) - case.target_speed_m_s
    over = share_of(error > limits.overspeed_margin_m_s, case.exit_weight)
    found = judgement(case.comparison.table.statistics, over, case.table.predicted, limits)
    judged = verdict_within(case_name(case), found, case.feasibility.unavoidable, limits)
    missed = case.comparison.table.statistics.rms_ci95_m_s[0] > limits.rms_m_s
    if judged.word == "missed" and missed:
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
    return f"which the position does not forbid: {unavoidable_text(case.feasibility.unavoidable)}"


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
