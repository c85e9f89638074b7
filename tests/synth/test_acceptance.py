"""The verdict: feasible cases against every limit, infeasible ones named and outside."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from synth.frame.command import Limit
from synth.retarder.acceptance import advice_of, judge_case, judged, limits_of
from synth.retarder.case_result import CaseResult
from synth.retarder.comparison.measured import judgement, prediction_ratio_of
from synth.retarder.configuration.settings import AcceptanceSettings
from synth.retarder.shown.checks import worst_of
from synth.simulation.exit_statistics import ExitStatistics, UnavoidableError, overspeed_of
from synth.simulation.passes import ExitSample
from tests.synth.case_factory import make_case
from tuning_tables import Decisions, Predicted

LIMITS = AcceptanceSettings()


def sound_case(label: str = "gondola-36t", target: float = 3.0, feasible: bool = True) -> CaseResult:
    return make_case(label, target, spread=0.05, feasible=feasible)


def statistics(**changes: object) -> ExitStatistics:
    """Figures of which the rms is certain to 2 %, the rest for sure."""
    rms = changes.get("rms_m_s", 0.05)
    assert isinstance(rms, float)
    nothing, sure = (0.0, 0.0), (9.0, 9.0)
    ideal = ExitStatistics(
        1000, rms, (rms / 1.02, 1.02 * rms), 0.0, nothing, rms, 0.1, nothing, 0.1, nothing, 0.0, nothing, 0.0, nothing,
        9.0, sure, 9.0, sure,
    )  # fmt: skip
    return replace(ideal, **changes)  # type: ignore[arg-type]  # fields by name


def limits(*cases: CaseResult, of: AcceptanceSettings = LIMITS) -> list[Limit]:
    """What the verdict on a book of these cases is made of."""
    return list(limits_of(judged(cases, of), cases, of, ()))


def test_a_book_that_keeps_the_limits() -> None:
    (limit,) = limits(sound_case(), sound_case("gondola-22t"))
    assert limit.kept
    assert limit.sentence.startswith("the limits are kept in 2 feasible cases; the worst rms is 0.0499 [")


def test_one_bad_case_refuses_the_book_and_says_why() -> None:
    bad = make_case("gondola-85t", 2.0, spread=0.15)
    (limit,) = limits(sound_case(), bad)
    assert limit.kept is False
    assert limit.sentence.startswith("gondola-85t, target 2 m/s: rms 0.14")
    assert limit.sentence.endswith(
        "which the position does not forbid: the rms that no regulator avoids is 0.0200 [0.0196, 0.0204] m/s"
    )
    assert advice_of(judged([sound_case(), bad], LIMITS)) == (
        'Try regulator.estimator = true, regulator.commands = "any_time", another fit.degree or another target.'
    )


def test_what_is_to_be_changed_follows_from_what_is_asked_for_and_what_is_missed() -> None:
    bad = make_case("gondola-85t", 2.0, spread=0.15)
    advice = judge_case(replace(bad, table=replace(bad.table, decisions=Decisions.AT_ANY_TIME)), LIMITS).advice
    assert advice == ("regulator.estimator = true", "another fit.degree or another target")
    assert judge_case(sound_case(), LIMITS).advice == ()
    assert judge_case(sound_case(feasible=False), LIMITS).advice == ()
    slow = replace(sound_case(), table=replace(sound_case().table, predicted=Predicted(0.5, 0.0, 0.0, 9.0)))
    unsure = replace(slow, statistics=replace(slow.statistics, rms_ci95_m_s=(0.04, 0.2)))
    for case in (slow, unsure):
        verdict = judge_case(case, LIMITS)
        assert (verdict.word, verdict.advice) == ("missed", ())  # another limit than that of the rms


def test_a_tuned_law_that_keeps_the_limit_shows_that_the_position_can() -> None:
    bad = make_case("gondola-85t", 2.0, spread=0.15)
    (*others, best) = bad.comparison.baselines
    for high, words in ((0.1, "can: a tuned energy rule has 0.0900 m/s"), (0.101, "does not forbid: the rms that")):
        good = replace(best, statistics=statistics(rms_m_s=0.09, rms_ci95_m_s=(0.08, high)))
        case = replace(bad, comparison=replace(bad.comparison, baselines=(*others, good)))
        assert f"which the position {words}" in limits(case)[0].sentence


def test_cuts_that_are_too_slow_without_any_braking_are_named_so() -> None:
    bad = sound_case(feasible=False)
    verdict = judge_case(replace(bad, unavoidable=replace(bad.unavoidable, too_fast=False)), LIMITS)
    assert verdict.obstacle == "leaves too slow"


def test_infeasible_cases_do_not_count() -> None:
    bad = sound_case("gondola-85t", 2.0, feasible=False)
    verdict = judge_case(bad, LIMITS)
    assert verdict.word == "infeasible"
    assert verdict.judgement.missed  # still told
    (limit,) = limits(sound_case(), bad)
    assert limit.kept
    assert "in 1 feasible case;" in limit.sentence


def test_the_worst_off_nominal_is_told_of_the_cases_that_count() -> None:
    worst = worst_of([sound_case()])
    assert worst is not None
    assert worst.told.startswith(
        "Off nominal, for which there is no limit, the worst is gondola-36t, target 3 m/s with a third"
    )
    assert worst_of([]) is None


def test_a_book_without_a_feasible_case_is_not_accepted() -> None:
    (limit,) = limits(sound_case(feasible=False))
    assert limit.kept is False
    assert "nothing to accept" in limit.sentence


RMS = "rms 0.0990 [0.0971, 0.1010] m/s, allowed 0.1"
HONEST = "predicted / simulated rms 0.890 [0.873, 0.908], allowed 0.9 to 1.1"


@pytest.mark.parametrize(
    ("found", "overspeed", "honest", "missed", "undecided"),
    [
        (statistics(), (0.0, 0.0), 1.0, (), ()),
        (statistics(rms_m_s=0.1 / 1.02), (0.04, 0.05), 0.92, (), ()),  # a limit itself is kept
        (statistics(stalled=0.01, stalled_ci95=(0.01, 0.01)), (0.0, 0.0), 1.07, (), ()),
        (statistics(rms_m_s=0.099), (0.0, 0.0), 1.0, (), (RMS,)),
        (statistics(rms_m_s=0.103), (0.0, 0.0), 1.0, ("rms 0.1030 [0.1010, 0.1051] m/s, allowed 0.1",), ()),
        (statistics(), (0.051, 0.06), 1.0,
         ("over-speed in 5.500% [5.100%, 6.000%] of the cuts, allowed 5.000%",), ()),
        (statistics(), (0.04, 0.06), 1.0, (),
         ("over-speed in 5.500% [4.000%, 6.000%] of the cuts, allowed 5.000%",)),
        (statistics(stalled=0.011, stalled_ci95=(0.009, 0.013)), (0.0, 0.0), 1.0, (),
         ("stop in the position in 1.100% [0.900%, 1.300%] of the cuts, allowed 1.000%",)),
        (statistics(), (0.0, 0.0), 0.89, (), (HONEST,)),
        (statistics(), (0.0, 0.0), 0.88,
         ("predicted / simulated rms 0.880 [0.863, 0.898], allowed 0.9 to 1.1",), ()),
        (statistics(), (0.0, 0.0), 1.13,
         ("predicted / simulated rms 1.130 [1.108, 1.153], allowed 0.9 to 1.1",), ()),
        (statistics(rms_m_s=0.0), (0.0, 0.0), 1.0,
         ("predicted / simulated rms nan [nan, nan], allowed 0.9 to 1.1",), ()),
    ],
)  # fmt: skip
def test_every_limit(
    found: ExitStatistics, overspeed: tuple[float, float], honest: float, missed: tuple[str, ...],
    undecided: tuple[str, ...],
) -> None:  # fmt: skip
    predicted = Predicted(honest * found.rms_m_s, 0.0, 0.0, 9.0)
    said = judgement(found, (0.055, overspeed), predicted, LIMITS)
    assert (said.missed, said.undecided) == (missed, undecided)
    assert said.word == ("missed" if missed else "not decidable" if undecided else "accepted")


def test_time_and_commands_are_judged_where_limits_are_set() -> None:
    """The defaults switch both off."""
    found = statistics(time_s=9.5, time_ci95_s=(9.4, 9.6), switchings=9.0, switchings_ci95=(8.5, 9.5))
    predicted = Predicted(found.rms_m_s, 0.0, 0.0, 9.0)
    slow, busy = LIMITS.model_copy(update={"time_s": 9.0}), LIMITS.model_copy(update={"switchings": 9.0})
    assert judgement(found, (0.0, (0.0, 0.0)), predicted, LIMITS).word == "accepted"
    assert judgement(found, (0.0, (0.0, 0.0)), predicted, slow).missed == (
        "9.50 [9.40, 9.60] s in the position, allowed 9",
    )
    assert judgement(found, (0.0, (0.0, 0.0)), predicted, busy).undecided == (
        "9.00 [8.50, 9.50] commands a cut, allowed 9",
    )


def test_a_simulated_prediction_is_uncertain_too() -> None:
    """Predicted from as many passes as it is checked with: the interval is wider by the root of 2."""
    exact = prediction_ratio_of(0.05, None, statistics())[1]
    sampled = prediction_ratio_of(0.05, 1000, statistics())[1]
    assert math.log(sampled[1]) == pytest.approx(math.sqrt(2.0) * math.log(exact[1]))


@pytest.mark.requirement("PRED-07")
def test_a_book_that_the_passes_cannot_judge_says_so() -> None:
    of = AcceptanceSettings(rms_m_s=0.05)
    (limit,) = limits(sound_case(), of=of)
    assert limit.kept is None
    assert limit.sentence.startswith("gondola-36t, target 3 m/s: not decidable with these passes: rms 0.0499 [")
    assert advice_of(judged([sound_case()], of)) == ("Try a larger validation.passes where a limit is not decidable.")


def test_a_miss_does_not_count_where_the_passes_cannot_tell_whether_the_case_is_feasible() -> None:
    bad = make_case("gondola-85t", 2.0, spread=0.15)
    unsure = replace(bad, unavoidable=UnavoidableError(0.1, (0.09, 0.11), True))
    (limit,) = limits(sound_case(), unsure)
    assert limit.kept is None
    assert "0.1000 [0.0900, 0.1100] m/s, too near to the limit to tell whether the case is feasible" in limit.sentence


def test_overspeed_is_counted_beyond_the_configured_margin() -> None:
    speeds = np.tile([0.0, 3.0, 3.2, 3.4], 100)
    sample = ExitSample(speeds, speeds == 0.0, np.zeros(400, np.int32), np.ones(400), np.ones(400))
    assert [overspeed_of(sample, 3.0, margin)[0] for margin in (0.1, 0.3, 0.5)] == [0.5, 0.25, 0.0]
