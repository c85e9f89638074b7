"""Trials of the study of robustness: tables on other plants, and tables tuned for these."""

from __future__ import annotations

import pytest

from scripts.studies.plant_changes import aged_valves
from scripts.studies.robustness.perturbation import Perturbation
from scripts.studies.robustness.study import one_at_a_time
from scripts.studies.robustness.trial import Trial, trial_of
from scripts.studies.tuned_table import tuned_table as retuned
from synth.problem.resolution import finer_for_check
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configuration.plant_parameter import Parameter
from synth.retarder.rounded_table import predict
from synth.simulation.random_passes import random_passes
from synth.solver.chain.chain import check_chain
from tests.synth.case_factory import make_plant, make_table


@pytest.fixture(scope="module")
def trial() -> Trial:
    plant = make_plant(36.0, 4)
    return trial_of("test", make_table("test", plant, 3.0), plant, random_passes(13, 0, 300))


def test_nominal_passes_have_the_ratio_one(trial: Trial) -> None:
    outcome = trial.outcome(Perturbation("nominal"))
    assert (outcome.ratio, outcome.ratio_ci95) == (1.0, (1.0, 1.0))
    assert outcome.bias_ci95_m_s[0] < outcome.bias_m_s < outcome.bias_ci95_m_s[1]


def test_strongest_parameter_comes_first(trial: Trial) -> None:
    K = 20.0 / 550.0
    slope = Parameter("retarder.force.slope_kn_per_kpa", "K", K, True, sensible=(0.5 * K, 1.5 * K))
    spread = Parameter("friction.axle_cv", "axle CV", 0.0, True, sensible=(0.0, 0.3))
    found = one_at_a_time(trial, (spread, slope))
    assert [row.name for row in found] == ["K", "axle CV"]
    assert found[0].values == (0.5 * K, 1.5 * K)
    assert found[1].less.ratio == 1.0 != found[1].more.ratio


@pytest.fixture(scope="module")
def tuned() -> Trial:
    """The 52 t class of the default book with a table for 3 m/s."""
    config = load_config(None)
    label, plant = config.plants()[2]
    assert label.endswith("52t")
    return trial_of("52 t", retuned(config, plant, 3.0), plant, random_passes(14, 0, 2000))


@pytest.mark.long
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
