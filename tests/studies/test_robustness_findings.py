"""Tables of the study of robustness: which parameters they show, and in which order."""

from __future__ import annotations

from scripts.studies.robustness.findings import EndsRow, OutcomeRow, by_effect, without_mass


def outcome(ratio: float, retuned: float | None = None) -> OutcomeRow:
    rms, none = 0.05 * ratio, (0.0, 0.0)
    ends = (0.9 * rms, 1.1 * rms)
    return OutcomeRow("x", "", rms, ends, ratio, none, 0.0, none, 0.0, none, 0.0, none, 1.0, retuned, None)


def ends(key: str, less: float, more: float) -> EndsRow:
    return EndsRow(key, key.upper(), 1.0, (0.5, 1.5), outcome(less), outcome(more))


def test_the_worse_end_is_told_with_its_value() -> None:
    assert (ends("a", 2.0, 1.0).worst_value, ends("a", 1.0, 2.0).worst_value) == (0.5, 1.5)
    assert outcome(2.0).cell == "0.100 [0.090, 0.110]"
    assert outcome(2.0, 0.07).cell == "0.100 [0.090, 0.110] / 0.070"


def test_parameters_come_by_their_largest_effect_in_any_case() -> None:
    cases = [[ends("a", 1.2, 1.1), ends("b", 1.0, 1.3)], [ends("a", 1.0, 1.5), ends("c", 1.1, 1.0)]]
    found = by_effect(cases)
    assert [(name, ratio) for name, ratio, _ in found] == [("A", 1.5), ("B", 1.3), ("C", 1.1)]
    assert [row is None for row in found[1][2]] == [False, True]


def test_the_mass_of_a_condition_is_left_out() -> None:
    assert without_mass("lightest cut of the category, 22 t") == "lightest cut of the category"
    assert without_mass("dead band × 2") == "dead band × 2"
