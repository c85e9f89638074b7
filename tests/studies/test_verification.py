"""The study of `verify`: samples of whole groups, and doubts of a table whose truth is known."""

from __future__ import annotations

from dataclasses import replace
from random import Random

import pytest

from scripts.studies.verification import (
    FACTORS,
    USUAL_PREDICTION_RATIO,
    doubts_of,
    sample_of,
    with_rms_times,
)
from synth.checker.coarse_simulation import Passes
from synth.checker.low_friction import GROUP
from synth.checker.table_reading import Table, read_table
from tests.tuning_tables.conftest import table
from tuning_tables import ControllerTable, Predicted, to_json

RMS_M_S = 0.05
__all__ = ["table"]


@pytest.fixture
def true_table(table: ControllerTable) -> Table:
    """It states what `pool_of(…, RMS_M_S)` does."""
    return read_table(to_json(replace(table, predicted=Predicted(RMS_M_S, 0.0, 0.0, 4.0))))


def pool_of(count: int, rms_m_s: float) -> Passes:
    """Passes to 4 m/s with independent normal errors and four switchings."""
    random = Random(3)
    return Passes(
        exit_m_s=tuple(4.0 + random.gauss(0.0, rms_m_s) for _ in range(count)),
        stalled=(False,) * count,
        switchings=(4,) * count,
        weight=(1.0,) * count,
        as_it_comes=(True,) * count,
    )


def test_a_sample_consists_of_whole_groups() -> None:
    pool = replace(pool_of(4 * GROUP, RMS_M_S), exit_m_s=tuple(float(i) for i in range(4 * GROUP)))
    drawn = sample_of(pool, 3 * GROUP, Random(1)).exit_m_s
    for start in range(0, 3 * GROUP, GROUP):
        group = drawn[start : start + GROUP]
        assert group[0] % GROUP == 0
        assert group == tuple(group[0] + i for i in range(GROUP))
    assert len(sample_of(pool, GROUP + 1, Random(1)).exit_m_s) == GROUP + 1


def test_a_table_that_states_the_truth_is_not_doubted_and_one_that_does_not_is(true_table: Table) -> None:
    found = doubts_of(true_table, pool_of(4000, RMS_M_S), USUAL_PREDICTION_RATIO, 1000, 20)
    shares = {each.factor: each.share for each in found}
    assert tuple(shares) == FACTORS
    assert shares[1.0] == 0.0
    assert shares[0.5] == 1.0
    assert {each.passes for each in found} == {1000}


def test_another_rms_is_stated_with_its_interval_and_the_same_bias(true_table: Table) -> None:
    other = with_rms_times(true_table, 0.5)
    assert other.predicted_rms_m_s == other.validated_rms_m_s == 0.5 * RMS_M_S
    assert other.validated_ci95_m_s == (0.5 * 0.049, 0.5 * 0.051)
    assert other.bias_m_s == true_table.bias_m_s
