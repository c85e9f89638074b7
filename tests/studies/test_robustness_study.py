"""The experiments: pairing, Latin hypercube, sweeps, and tables tuned for the true plant."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from scripts.studies.robustness.condition import aged_valves, friction
from scripts.studies.robustness.experiments import (
    hypercube,
    one_at_a_time,
    steepest,
    sweep,
    together,
    tolerated,
)
from scripts.studies.robustness.perturbation import Perturbation, ends_by
from scripts.studies.robustness.sensor_fault import Bias
from scripts.studies.robustness.trial import Trial, trial_of
from scripts.studies.tuned_table import tuned_table as retuned
from synth.book.rounded_table import predict
from synth.configuration.config_file import load_config
from synth.configuration.plant_parameter import Parameter
from synth.problem.resolution import finer_for_check
from synth.simulation.exit_statistics import rms_ratio
from synth.simulation.random_passes import random_passes
from synth.solver.chain.chain import check_chain
from tests.synth.case_factory import make_plant, make_sample, make_table


@pytest.fixture(scope="module")
def trial() -> Trial:
    plant = make_plant(36.0, 4)
    return trial_of("test", make_table("test", plant, 3.0), plant, random_passes(13, 0, 300))


@pytest.fixture(scope="module")
def few() -> tuple[Parameter, ...]:
    return (
        Parameter("retarder.force.slope_kn_per_kpa", "K", 20.0 / 550.0, True),
        Parameter("sensor.noise_m_s", "noise", 0.05, True),
        Parameter("friction.axle_cv", "axle CV", 0.0, True, largest=0.3),
        Parameter("cut.mass_t", "mass", 36.0, False, 28.0, 44.0),
    )


def test_nominal_passes_have_the_ratio_one(trial: Trial) -> None:
    outcome = trial.outcome(Perturbation("nominal"))
    assert (outcome.ratio, outcome.ratio_ci95) == (1.0, (1.0, 1.0))
    assert outcome.bias_ci95_m_s[0] < outcome.bias_m_s < outcome.bias_ci95_m_s[1]


def test_the_ratio_is_paired() -> None:
    sample = make_sample(3.1, 0.05, 1)
    speed = 3.0 + 2.0 * (sample.exit_speed_m_s - 3.0)
    doubled = replace(sample, exit_speed_m_s=speed)
    ratio, interval = rms_ratio(doubled, sample, 3.0)
    assert ratio == pytest.approx(2.0)
    assert interval == pytest.approx((2.0, 2.0))  # the same passes: no chance is left


def test_the_interval_of_the_ratio_covers() -> None:
    hits = 0
    for seed in range(200):
        wide, narrow = make_sample(3.0, 0.06, 2 * seed), make_sample(3.0, 0.05, 2 * seed + 1)
        low, high = rms_ratio(wide, narrow, 3.0)[1]
        hits += low < 1.2 < high
    assert 180 <= hits <= 199  # 95 % of 200, and four standard deviations


def test_a_trial_of_fewer_passes_is_a_part_of_it(trial: Trial) -> None:
    part = trial.first(100)
    assert np.array_equal(part.nominal.exit_speed_m_s, trial.nominal.exit_speed_m_s[:100])
    worse = Perturbation("slippery", friction(0.8, 1.0))
    assert np.array_equal(part.sample(worse).exit_speed_m_s, trial.sample(worse).exit_speed_m_s[:100])


def test_strongest_parameter_comes_first(trial: Trial, few: tuple[Parameter, ...]) -> None:
    found = one_at_a_time(trial, few, ends_by(0.5))
    assert [row.worst.rms_m_s for row in found] == sorted(r.worst.rms_m_s for r in found)[::-1]
    assert found[0].name == "K"
    assert {row.key for row in found} == {p.key for p in few}
    zero = next(row for row in found if row.name == "axle CV")
    assert zero.less.ratio == 1.0 != zero.more.ratio


def test_a_sweep_passes_through_the_nominal_plant(trial: Trial, few: tuple[Parameter, ...]) -> None:
    found = sweep(trial, few[0], (-0.1, 0.0, 0.1), 0.1)
    nominal = trial.outcome(Perturbation("nominal")).rms_m_s
    assert found.rms_m_s[1] == nominal
    assert found.rms_m_s[0] != nominal != found.rms_m_s[2]


def test_where_a_sweep_passes_the_limit() -> None:
    relative, rms = (-0.2, -0.1, 0.0, 0.1, 0.2), (0.3, 0.15, 0.05, 0.04, 0.06)
    low, high = tolerated(relative, rms, 0.1)
    assert low == pytest.approx(-0.05)
    assert high is None
    assert tolerated(relative, rms, 0.055) == pytest.approx((-0.005, 0.175))
    assert tolerated(relative, rms, 0.03) == (0.0, 0.0)
    assert steepest(rms) == pytest.approx(3.0)


def test_latin_hypercube_is_one_in_every_stratum() -> None:
    relative = hypercube(5, 0.2, 16, seed=3)
    strata = np.floor((relative / 0.2 + 1.0) * 8.0).astype(int)
    assert all(sorted(column.tolist()) == list(range(16)) for column in strata.T)


def test_all_together_varies_what_is_assumed_and_not_zero(trial: Trial, few: tuple[Parameter, ...]) -> None:
    one = together(trial.first(200), few, 0.2, 16, seed=3)
    assert one.names == ("K", "noise")
    assert len(set(one.rms_m_s)) == 16
    share, (low, high) = one.share_within(float(np.median(one.rms_m_s)))
    assert low < share == 0.5 < high
    middle, (below, above) = one.quantile_m_s(0.5)
    assert min(one.rms_m_s) <= below < middle < above <= max(one.rms_m_s)


@pytest.fixture(scope="module")
def tuned() -> Trial:
    """The 52 t class of the default book with a table for 3 m/s."""
    config = load_config(None)
    label, plant = config.plants()[2]
    assert label.endswith("52t")
    return trial_of("52 t", retuned(config, plant, 3.0), plant, random_passes(14, 0, 2000))


def test_a_bias_of_the_sensor_is_a_bias_of_the_exit_speed(tuned: Trial) -> None:
    high, low = (tuned.outcome(Perturbation("bias", fault=Bias(b))) for b in (0.1, -0.1))
    assert 0.5 * (low.bias_m_s - high.bias_m_s) == pytest.approx(0.1, abs=0.02)


def test_a_table_tuned_for_the_true_plant_is_better_there_and_worse_elsewhere(tuned: Trial) -> None:
    aged = Perturbation("aged valves", aged_valves)
    other = retuned(load_config(None), aged.change(tuned.plant), 3.0)
    assert tuned.outcome(aged, other).ratio < 0.8 * tuned.outcome(aged).ratio
    assert tuned.outcome(Perturbation("nominal"), other).ratio_ci95[0] > 1.0


def test_a_wrong_table_does_what_the_exact_density_predicts(tuned: Trial) -> None:
    aged = Perturbation("aged valves", aged_valves)
    check = check_chain(aged.change(tuned.plant), finer_for_check(load_config(None).resolution))
    predicted = predict(check, tuned.table).rms_m_s(3.0)
    assert predicted / tuned.outcome(aged).rms_m_s == pytest.approx(1.0, abs=0.1)
    assert predicted > 1.8 * tuned.outcome(Perturbation("nominal")).rms_m_s
