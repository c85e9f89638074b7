"""Regret is told against a reference that nothing beats which is not told the friction."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from synth.retarder.shown.results import NO_REGRET, overall, remarks
from tests.synth.case_factory import make_case
from tests.synth.test_report import found_book


@pytest.mark.parametrize(
    ("to_baseline", "to_table", "told"),
    [
        ((0.4, 0.6), (1.05, 1.10), True),
        ((0.98, 1.02), (0.99, 1.01), True),  # chance alone
        ((math.nan, math.nan), (1.05, 1.10), True),
        ((1.01, 1.05), (1.05, 1.10), False),  # a tuned law is better
        ((0.4, 0.6), (0.95, 0.99), False),  # the table is
    ],
)
def test_a_regulator_that_is_beaten_is_no_reference(
    to_baseline: tuple[float, float], to_table: tuple[float, float], told: bool
) -> None:
    found = make_case().comparison
    known = replace(found.friction_known, table_ratio_ci95=to_table)
    compared = replace(found, friction_known=known, baseline_ratio_ci95=to_baseline)
    assert compared.has_reference is told
    if told:
        assert (compared.regret, compared.regret_ci95) == (known.table_ratio, to_table)
    else:
        assert math.isnan(compared.regret)
        assert all(map(math.isnan, compared.regret_ci95))


def test_the_median_of_the_summary_is_over_cases_with_a_reference() -> None:
    case = make_case()
    beaten = replace(case, comparison=replace(case.comparison, baseline_ratio_ci95=(1.1, 1.2)))
    assert overall(found_book((case, beaten)))["median_regret"] == case.comparison.regret
    assert overall(found_book((beaten,)))["median_regret"] is None


def test_a_regret_that_is_left_out_is_explained() -> None:
    case = make_case()
    beaten = replace(case, comparison=replace(case.comparison, baseline_ratio_ci95=(1.1, 1.2)))
    assert NO_REGRET not in remarks(found_book((case,)))
    assert NO_REGRET in remarks(found_book((case, beaten)))
