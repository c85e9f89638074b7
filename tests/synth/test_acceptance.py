"""The verdict: feasible cases against every limit, infeasible ones named and outside."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from synth.configuration.settings import AcceptanceSettings
from synth.output.acceptance import judge, missed_limits, overspeed_share
from synth.simulation.exit_statistics import ExitStatistics
from synth.tuning.case_result import CaseResult
from tests.synth.case_factory import make_case

LIMITS = AcceptanceSettings()


def honest_case(label: str = "gondola-36t", target: float = 3.0, feasible: bool = True) -> CaseResult:
    return make_case(label, target, spread=0.05, feasible=feasible)


def statistics(**changes: float) -> ExitStatistics:
    """The interval of the rms is 2 % to both sides."""
    rms = changes.get("rms_m_s", 0.05)
    ideal = ExitStatistics(1000, rms, (rms / 1.02, 1.02 * rms), 0.0, 0.05, 0.1, 0.0, (0.0, 0.003), 0, 9.0)
    return replace(ideal, **changes)  # type: ignore[arg-type]  # fields are numbers


def test_a_book_that_keeps_the_limits() -> None:
    verdict = judge([honest_case(), honest_case("gondola-22t")], LIMITS)
    assert verdict.accepted
    assert [case.word for case in verdict.cases] == ["accepted", "accepted"]
    assert verdict.sentence.startswith("the limits are kept in 2 feasible cases; the worst rms is 0.05")
    assert "infeasible" not in verdict.sentence


def test_one_bad_case_refuses_the_book_and_says_why() -> None:
    verdict = judge([honest_case(), make_case("gondola-85t", 2.0, spread=0.15)], LIMITS)
    assert not verdict.accepted
    assert [case.word for case in verdict.cases] == ["accepted", "missed"]
    assert "missed in 1 of 2 feasible cases (gondola-85t, target 2 m/s: rms 0.14" in verdict.sentence
    assert "allowed 0.1" in verdict.sentence


def test_infeasible_cases_are_named_and_do_not_count() -> None:
    bad = honest_case("gondola-85t", 2.0, feasible=False)
    verdict = judge([honest_case(), bad], LIMITS)
    assert verdict.accepted
    assert verdict.cases[1].word == "infeasible"
    assert verdict.cases[1].missed  # still told
    assert "in 1 feasible case;" in verdict.sentence
    assert verdict.sentence.endswith(
        "infeasible and outside this verdict: gondola-85t, target 2 m/s (out of brake power)"
    )


def test_a_book_without_a_feasible_case_is_not_accepted() -> None:
    verdict = judge([honest_case(feasible=False)], LIMITS)
    assert not verdict.accepted
    assert "nothing to accept" in verdict.sentence


@pytest.mark.parametrize(
    ("found", "overspeed", "honest", "said"),
    [
        (statistics(), 0.0, 1.0, ()),
        (statistics(rms_m_s=0.1), 0.05, 0.9, ()),  # a limit itself is kept
        (statistics(stalls=10), 0.0, 1.1, ()),
        (statistics(rms_m_s=0.101), 0.0, 1.0, ("rms 0.1010 m/s, allowed 0.1",)),
        (statistics(), 0.051, 1.0, ("over-speed in 5.100% of the passes, allowed 5.000%",)),
        (statistics(stalls=11), 0.0, 1.0, ("stop in the position in 1.100% of the passes, allowed 1.000%",)),
        (statistics(), 0.0, 0.89, ()),  # its interval reaches 0.9
        (statistics(), 0.0, 1.12, ()),
        (statistics(), 0.0, 0.88, ("predicted / simulated rms 0.880 [0.863, 0.898], allowed 0.9 to 1.1",)),
        (statistics(), 0.0, 1.13, ("predicted / simulated rms 1.130 [1.108, 1.153], allowed 0.9 to 1.1",)),
        (statistics(), 0.0, math.nan, ("predicted / simulated rms nan [nan, nan], allowed 0.9 to 1.1",)),
    ],
)
def test_every_limit(found: ExitStatistics, overspeed: float, honest: float, said: tuple[str, ...]) -> None:
    assert missed_limits(found, overspeed, honest, LIMITS) == said


def test_overspeed_is_counted_beyond_the_configured_margin() -> None:
    speeds = np.array([0.0, 3.0, 3.2, 3.4], dtype=np.float32)
    assert [overspeed_share(speeds, 3.0, margin) for margin in (0.1, 0.3, 0.5)] == [0.5, 0.25, 0.0]
