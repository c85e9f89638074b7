"""Page's sums: by hand, their rate of false alarms against the bound, and one pass that is far off."""

from __future__ import annotations

import math

import numpy as np
from scipy.stats import chi2

from synth.logs.drift.causes import TIMES, Cause, Remedy
from synth.logs.drift.charts import (
    FEWEST,
    MOST,
    WINDOW,
    charts_of,
    limit_of,
    page_sums,
    running_medians,
    steps_of,
)
from synth.logs.drift.evidence import Evidence


def normal_evidence(x: np.ndarray) -> Evidence:
    """Exact: observations (m,) of N(0, 1), drifts of the mean to log(size)."""
    sizes = (math.exp(-1.0), 1.0, math.exp(1.0))
    cause = Cause("mean", "mean", ("mean",), TIMES, sizes, (sizes[0], sizes[2]), Remedy.RETUNE, "")
    d = np.log(sizes)
    return Evidence((cause,), (x[:, None] * d - 0.5 * d**2,), np.zeros(len(x)))


def test_sums_by_hand() -> None:
    steps = np.array([[1.0], [-2.0], [3.0], [-1.0], [2.0]])
    assert page_sums(steps)[:, 0].tolist() == [1.0, 0.0, 3.0, 2.0, 4.0]
    assert page_sums(-steps)[:, 0].tolist() == [0.0, 2.0, 0.0, 1.0, 0.0]


def test_the_rate_of_false_alarms_of_an_exact_likelihood_keeps_the_bound() -> None:
    """At a low limit, where there are enough of them: e^-h for each chart."""
    rng = np.random.default_rng(5)
    steps, limit, lanes, length = steps_of(normal_evidence(rng.standard_normal(400_000))), limit_of(2, 100.0), 400, 1000
    lanes_of = steps.reshape(length, lanes, 2)
    sums, alarms = np.zeros((lanes, 2)), 0
    for step in lanes_of:
        sums = np.maximum(sums + step, 0.0)
        over = (sums >= limit).any(axis=1)
        alarms += int(over.sum())
        sums[over] = 0.0
    most = chi2.ppf(0.9999, 2 * alarms + 2) / 2.0 / (lanes * length)
    assert alarms > 100
    assert most <= 0.01, "the bound does not hold"
    assert alarms / (lanes * length) > 0.01 / 50.0, "this test could not fail"


def test_a_pass_far_off_gives_no_alarm_and_a_drift_does() -> None:
    x = np.zeros(60)
    x[30] = 1000.0
    assert charts_of(normal_evidence(x)).alarm is None
    x[30:] = 1.0
    charts = charts_of(normal_evidence(x))
    # 0.5 a pass since the drift; before it the sum stays at 0.
    first = 30 + math.ceil(charts.limit / 0.5) - 1
    assert charts.alarm == (first, 1)
    assert charts.zero_before(first, 1) == 29
    assert limit_of(20) > 3 * MOST


def test_a_running_median_follows_a_shift_and_not_a_few_cuts_out_of_brake() -> None:
    errors = np.concatenate((np.tile([-0.1, 0.1, 0.0, 0.0], 25), np.full(60, 0.2)))
    errors[[20, 21, 40, 60, 80]] = 1.5
    medians = running_medians(errors)
    assert np.isnan(medians[: FEWEST - 1]).all()
    assert np.abs(medians[FEWEST - 1 : 100]).max() <= 0.1
    assert medians[100 + WINDOW :].tolist() == [0.2] * (60 - WINDOW)
