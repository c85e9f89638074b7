"""Studies of figures: intervals, passes near the target, the reserve, `verify`; each against a known truth."""

from __future__ import annotations

import math
from dataclasses import replace
from random import Random

import numpy as np
import pytest
from numpy.typing import NDArray

from scripts.studies.coverage import CASES, RATIO, block, configuration, interval_of, intervals, shares_held
from scripts.studies.estimator.reserve_study import excess_outside
from scripts.studies.near_target import NEAR_M_S, log_rms_near, near_ratio, near_target
from scripts.studies.verification import FACTORS, USUAL_PREDICTION_RATIO, doubts_of, sample_of, with_rms_times
from synth.checker.coarse_simulation import Passes
from synth.checker.drawn_cuts import GROUP
from synth.checker.table_reading import Table, read_table
from synth.frame.faults import InputError
from synth.simulation.passes import ExitSample
from synth.simulation.replicates import REPLICATE_PASSES
from tests.tuning_tables.conftest import table
from tuning_tables import ControllerTable, Predicted, to_json


def sample(error: np.ndarray, target: float = 3.0) -> ExitSample:
    """Passes with these exit errors, no stall, two switchings each, all of the same weight."""
    n = len(error)
    return ExitSample(
        exit_speed_m_s=target + error,
        stalled=np.zeros(n, np.bool_),
        switchings=np.full(n, 2, np.int32),
        transit_time_s=np.full(n, 10.0),
        weight=np.ones(n),
    )


def test_independent_normal_errors_are_held_as_often_as_an_interval_of_95_per_cent_says() -> None:
    """The oracle is the binomial law: 95 % of 400 blocks, ± four standard deviations (0.011 each)."""
    error = np.random.default_rng(5).normal(0.0, 0.05, (3, 400 * 1000))
    samples = [sample(each) for each in error]
    held = shares_held(samples, 3.0, 1000, 400)
    for name in ("rms", "bias", "95 of 100", "99 of 100", RATIO):
        share = held[name]
        assert share is not None
        assert share == pytest.approx(0.95, abs=0.044), name


def test_blocks_that_do_not_tell_of_one_law_are_not_held() -> None:
    """Every block has another mean: an interval from within a block misses the mean of all."""
    rng = np.random.default_rng(5)
    error = rng.normal(0.0, 0.05, (20, 1000)) + np.linspace(-0.1, 0.1, 20)[:, None]
    drifting = sample(error.ravel())
    held = shares_held([drifting, drifting, drifting], 3.0, 1000, 20)
    assert held["bias"] is not None
    assert held["bias"] <= 0.2


def test_a_figure_that_is_never_met_has_no_share() -> None:
    quiet = sample(np.random.default_rng(1).normal(0.0, 0.01, 4000))
    assert shares_held([quiet, quiet, quiet], 3.0, 1000, 4)["over-speed"] is None


def test_every_figure_finds_its_interval() -> None:
    assert interval_of("rms_m_s") == "rms_ci95_m_s"
    assert interval_of("overspeed") == "overspeed_ci95"
    quiet = sample(np.random.default_rng(1).normal(0.0, 0.05, 2000))
    found = intervals([quiet, quiet, quiet], 3.0)
    assert len(found) == 9
    value, (low, high) = found["rms"]
    assert low < value < high
    assert value == pytest.approx(0.05, rel=0.05)


def test_a_block_is_a_stretch_of_all_columns() -> None:
    whole = sample(np.arange(10.0))
    part = block(whole, 3, 4)
    assert part.exit_speed_m_s.tolist() == [6.0, 7.0, 8.0, 9.0]
    assert len(part.weight) == len(part.stalled) == 4


@pytest.mark.parametrize("case", ["knp-5-bunch", "knp-5-bunch:heavy:3", "a:1:2:3"])
def test_a_bad_case_is_told(case: str) -> None:
    with pytest.raises(InputError, match=f"give POSITION:MASS:TARGET as in {CASES[0]}"):
        configuration(case)


TARGET_M_S = 3.0


def weighted_sample(error: np.ndarray, weight: np.ndarray) -> ExitSample:
    none = np.zeros(len(error))
    values = {"exit_speed_m_s": TARGET_M_S + error, "weight": weight}
    names = ExitSample.__dataclass_fields__
    return ExitSample(**{name: values.get(name, none) for name in names})


def drawn(rng: np.random.Generator, count: int, std_m_s: float, far: float = 0.02) -> np.ndarray:
    """Errors of which a share `far` is brake saturated, 1 m/s too fast."""
    return np.where(rng.random(count) < far, 1.0, rng.normal(0.0, std_m_s, count))


def test_far_passes_count_in_the_share_alone() -> None:
    error, weight = np.array([0.1, -0.2, 0.5, 0.1] * 50), np.array([1.0, 2.0, 0.5, 1.5] * 50)
    found = near_target(weighted_sample(error, weight), TARGET_M_S)
    assert found.rms_m_s == pytest.approx(math.sqrt((1.0 * 0.01 + 2.0 * 0.04 + 1.5 * 0.01) / 4.5))
    assert found.outside == pytest.approx(0.5 / 5.0)


def test_the_influence_is_the_derivative_by_the_weights() -> None:
    rng = np.random.default_rng(1)
    error, weight = drawn(rng, 40, 0.1, 0.2), rng.uniform(0.5, 2.0, 40)
    _, influence = log_rms_near(error, weight)
    assert influence.sum() == pytest.approx(0.0, abs=1e-10)
    for i in range(len(error)):
        step = np.zeros(40)
        step[i] = 1e-6 * weight[i]
        slope = (log_rms_near(error, weight + step)[0] - log_rms_near(error, weight - step)[0]) / 2e-6
        assert influence[i] / weight.sum() == pytest.approx(slope, abs=1e-7)


def test_the_same_passes_have_the_ratio_one_for_certain() -> None:
    sample = weighted_sample(drawn(np.random.default_rng(2), 1000, 0.05), np.ones(1000))
    assert near_ratio(sample, sample, TARGET_M_S) == (1.0, (1.0, 1.0))


def test_doubled_errors_have_twice_the_rms() -> None:
    error = np.random.default_rng(3).uniform(-0.1, 0.1, 1000)
    once, twice = (weighted_sample(factor * error, np.ones(1000)) for factor in (1.0, 2.0))
    ratio, ends = near_ratio(twice, once, TARGET_M_S)
    assert ratio == pytest.approx(2.0)
    assert ends == pytest.approx((2.0, 2.0))


def test_the_interval_holds_the_truth_as_often_as_it_says() -> None:
    """Two controllers on the same passes, whose errors are partly common; some passes are far by one of them only."""
    rng, held, blocks = np.random.default_rng(4), 0, 400
    for _ in range(blocks):
        count = 20 * REPLICATE_PASSES
        common, weight = rng.normal(0.0, 0.04, count), rng.uniform(0.2, 2.0, count)
        ours, theirs = (common + rng.normal(0.0, std, count) for std in (0.03, 0.05))
        ours[rng.random(count) < 0.01] = 1.0
        truth = math.hypot(0.04, 0.03) / math.hypot(0.04, 0.05)  # beyond 0.3 m/s lies next to nothing of either
        low, high = near_ratio(weighted_sample(ours, weight), weighted_sample(theirs, weight), TARGET_M_S)[1]
        held += low <= truth <= high
    assert 0.91 * blocks <= held <= 0.99 * blocks
    assert 4.0 * math.hypot(0.04, 0.05) < NEAR_M_S


def as_sample(exits: NDArray[np.float64]) -> ExitSample:
    n = len(exits)
    return ExitSample(exits, np.zeros(n, dtype=bool), np.zeros(n, dtype=np.int32), np.ones(n), np.full(n, 0.5))


def test_more_outside_is_counted_pass_by_pass_with_its_weight() -> None:
    """Of 1000 passes 40 more are outside, four in every replicate: no chance is left in it."""
    exits = np.full(1000, 3.0)
    exits[::50] = 3.5
    worse = exits.copy()
    worse[7::25] = 2.0
    more, half_width = excess_outside((as_sample(exits), as_sample(worse)), 3.0)
    assert more == pytest.approx(0.04)
    assert half_width == pytest.approx(0.0, abs=1e-12)
    assert excess_outside((as_sample(worse), as_sample(exits)), 3.0)[0] == pytest.approx(-0.04)


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
