"""The study of intervals: counting blocks against a law whose answer is known, and which shares it calls a fault."""

from __future__ import annotations

import numpy as np
import pytest

from scripts.studies.coverage import (
    CASES,
    RATIO,
    block,
    configuration,
    interval_of,
    intervals,
    shares_held,
)
from synth.frame.input_error import InputError
from synth.simulation.passes import ExitSample


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
