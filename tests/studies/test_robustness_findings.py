"""Tables of the study of robustness: which parameters they show, in which order, and where a limit is passed."""

from __future__ import annotations

import pytest

from scripts.studies.robustness.findings import (
    EndsRow,
    OutcomeRow,
    SweepRow,
    TogetherRow,
    by_effect,
    crossed,
    without_mass,
)
from scripts.studies.robustness.study import strongest


def outcome(ratio: float, retuned: float | None = None) -> OutcomeRow:
    rms, none = 0.05 * ratio, (0.0, 0.0)
    ends = (0.9 * rms, 1.1 * rms)
    return OutcomeRow("x", "", rms, ends, ratio, none, 0.0, none, 0.0, none, 0.0, none, 1.0, retuned, None)


def ends(key: str, less: float, more: float, assumed: bool = True, nominal: float = 1.0) -> EndsRow:
    return EndsRow(key, key.upper(), assumed, nominal, (0.5, 1.5), outcome(less), outcome(more))


def test_the_worse_end_is_told_with_its_value() -> None:
    assert (ends("a", 2.0, 1.0).worst_value, ends("a", 1.0, 2.0).worst_value) == (0.5, 1.5)
    assert outcome(2.0).cell == "0.100 [0.090, 0.110]"
    assert outcome(2.0, 0.07).cell == "0.100 [0.090, 0.110] / 0.070"


def test_parameters_come_by_their_largest_effect_in_any_case() -> None:
    cases = [[ends("a", 1.2, 1.1), ends("b", 1.0, 1.3)], [ends("a", 1.0, 1.5), ends("c", 1.1, 1.0)]]
    found = by_effect(cases)
    assert [(name, ratio) for name, ratio, _ in found] == [("A", 1.5), ("B", 1.3), ("C", 1.1)]
    assert [row is None for row in found[1][2]] == [False, True]


def test_swept_are_assumed_values_that_are_not_zero_by_the_mean_over_the_cases() -> None:
    cases = [
        [ends("a", 4.0, 1.0), ends("b", 2.5, 1.0), ends("measured", 9.0, 1.0, assumed=False)],
        [ends("a", 1.0, 1.0), ends("b", 2.5, 1.0), ends("zero", 1.0, 9.0, nominal=0.0)],
    ]
    assert strongest(cases) == ["b", "a"]  # 2.5 · 2.5 > 4 · 1


@pytest.mark.parametrize(
    ("tolerated", "cell"),
    [((None, None), "never"), ((-0.152, None), "−15 %"), ((None, 0.3), "+30 %"), ((-0.2, 0.3), "−20 %, +30 %")],
)
def test_where_a_limit_is_passed(tolerated: tuple[float | None, float | None], cell: str) -> None:
    assert crossed(SweepRow("k", "K", (0.0,), (0.05,), 1.0, tolerated, ())) == cell


def test_correlations_within_chance_are_left_out() -> None:
    rms = tuple(float(i) for i in range(101))  # chance: 1.96 / 10
    row = TogetherRow(0.2, 5000, ("a", "b", "c"), (0.19, -0.5, 0.2), rms, rms, rms)
    assert row.leading == ("b -0.50", "c +0.20")
    assert row.share_within(50.0)[0] == pytest.approx(51 / 101)


def test_the_mass_of_a_condition_is_left_out() -> None:
    assert without_mass("lightest cut of the category, 22 t") == "lightest cut of the category"
    assert without_mass("dead band × 2") == "dead band × 2"
