"""Whether a book of tables keeps the limits that its configuration sets: the verdict, case by case, with reasons."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from synth.configuration.settings import AcceptanceSettings
from synth.plots.case_names import case_name, contest, honesty, why_infeasible
from synth.report.figures import counted
from synth.simulation.exit_statistics import ExitStatistics
from synth.tuning.case_result import CaseResult


@dataclass(frozen=True)
class CaseVerdict:
    """One case: `missed` names every limit that its table does not keep, whether it is feasible or not.

    `obstacle`: what makes the case infeasible, '' for a feasible one.
    """

    name: str
    obstacle: str
    missed: tuple[str, ...]

    @property
    def feasible(self) -> bool:
        """A controller that knows the friction would keep the limit of the rms."""
        return not self.obstacle

    @property
    def word(self) -> str:
        """'accepted', 'missed' or 'infeasible'."""
        if not self.feasible:
            return "infeasible"
        return "missed" if self.missed else "accepted"


@dataclass(frozen=True)
class Verdict:
    """`accepted`: there are feasible cases, and all of them keep every limit; `sentence` says it in words.

    Infeasible cases do not count, but the sentence names them.
    """

    accepted: bool
    sentence: str
    cases: tuple[CaseVerdict, ...]


def judge(cases: Sequence[CaseResult], limits: AcceptanceSettings) -> Verdict:
    """The verdict on the simulated passes of `cases`."""
    judged = tuple(judge_case(case, limits) for case in cases)
    feasible = [(case, verdict) for case, verdict in zip(cases, judged, strict=True) if verdict.feasible]
    bad = [verdict for _, verdict in feasible if verdict.missed]
    if not feasible:
        sentence = "no case is feasible, so there is nothing to accept"
    elif bad:
        found = "; ".join(f"{verdict.name}: {', '.join(verdict.missed)}" for verdict in bad)
        sentence = f"a limit is missed in {len(bad)} of {counted(len(feasible), 'feasible case')} ({found})"
    else:
        worst = max((case for case, _ in feasible), key=lambda case: contest(case).table.statistics.rms_m_s)
        rms = contest(worst).table.statistics.rms_m_s
        sentence = (
            f"the limits are kept in {counted(len(feasible), 'feasible case')}; the worst rms is {rms:.3f} m/s "
            f"({case_name(worst)}) where {limits.rms_m_s:g} m/s are allowed"
        )
    outside = [f"{verdict.name} ({verdict.obstacle})" for verdict in judged if not verdict.feasible]
    if outside:
        sentence += f"; infeasible and outside this verdict: {', '.join(outside)}"
    return Verdict(bool(feasible) and not bad, sentence, judged)


def judge_case(case: CaseResult, limits: AcceptanceSettings) -> CaseVerdict:
    """What one case misses, from the passes that its table was simulated on."""
    table = contest(case).table
    share = overspeed_share(case.exit_speeds_m_s, case.target_speed_m_s, limits.overspeed_margin_m_s)
    obstacle = "" if case.feasibility.feasible else why_infeasible(case)
    return CaseVerdict(case_name(case), obstacle, missed_limits(table.statistics, share, honesty(table), limits))


def missed_limits(
    found: ExitStatistics, overspeed: float, honest: float, limits: AcceptanceSettings
) -> tuple[str, ...]:
    """A phrase for every limit that a simulated table does not keep.

    `overspeed`: share of passes faster than target + margin; `honest`: predicted / simulated rms, where NaN misses.
    Honesty is missed only when its whole 95 % interval, that of the simulated rms, lies outside the limits: one
    rare pass among a few thousand must not condemn a prediction.
    """
    stalled = found.stalls / found.passes
    missed = []
    if not found.rms_m_s <= limits.rms_m_s:
        missed.append(f"rms {found.rms_m_s:.4f} m/s, allowed {limits.rms_m_s:g}")
    if not overspeed <= limits.p_overspeed:
        missed.append(f"over-speed in {overspeed:.3%} of the passes, allowed {limits.p_overspeed:.3%}")
    if not stalled <= limits.p_stall:
        missed.append(f"stop in the position in {stalled:.3%} of the passes, allowed {limits.p_stall:.3%}")
    low, high = (honest * found.rms_m_s / end if end else honest for end in reversed(found.rms_ci95_m_s))
    if not (low <= limits.honesty_high and high >= limits.honesty_low):
        span = f"{limits.honesty_low:g} to {limits.honesty_high:g}"
        missed.append(f"predicted / simulated rms {honest:.3f} [{low:.3f}, {high:.3f}], allowed {span}")
    return tuple(missed)


def overspeed_share(exit_speeds_m_s: np.ndarray, target_m_s: float, margin_m_s: float) -> float:
    """Share of the passes that leave faster than target + margin."""
    return float(np.mean(exit_speeds_m_s.astype(np.float64) - target_m_s > margin_m_s))
