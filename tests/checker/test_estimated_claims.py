"""The closed loop with an estimator, and claims that were themselves simulated."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path
from random import Random

import numpy as np
import pytest

from synth.checker.claims import PredictionRatio, own_faults, simulated_faults
from synth.checker.coarse_simulation import Passes, simulate
from synth.checker.statistics import FALSE_ALARM, binomial_tail, figures_of
from synth.checker.summary import Summary, read_summary
from synth.checker.table_reading import Table, read_table

PREDICTION_RATIO = PredictionRatio(0.8, 1.25)


@pytest.fixture(scope="module")
def summary(estimated_once: Path) -> Summary:
    return read_summary(estimated_once / "summary.json")


@pytest.fixture(scope="module")
def table(estimated_once: Path) -> Table:
    return read_table(max((estimated_once / "tables").glob("*.json")).read_bytes())


@pytest.fixture(scope="module")
def many(summary: Summary, table: Table) -> Passes:
    return simulate(summary.plant(table), table, 1200, 9)


@pytest.mark.long
def test_the_closed_loop_with_the_estimator_is_that_of_the_simulator(many: Passes, table: Table) -> None:
    """Two samples, within four standard errors and two percent of coarseness."""
    found_figures = figures_of(many, table.target_m_s)
    low, high = table.validated_ci95_m_s or (0.0, 0.0)
    own = found_figures.square_std / found_figures.mean_square / 2.0 / math.sqrt(found_figures.passes)
    apart = math.log(found_figures.rms_m_s / (table.validated_rms_m_s or 0.0))
    assert abs(apart) < 4.0 * math.hypot(own, math.log(high / low) / 2.0 / 1.96) + 0.02
    assert found_figures.switchings == pytest.approx(table.switchings, rel=0.05)


def test_without_running_the_estimator_the_claims_would_be_doubted(summary: Summary, table: Table) -> None:
    plant, blind = summary.plant(table), dataclasses.replace(table, estimator=None)
    figures = figures_of(simulate(plant, blind, 300, 1), table.target_m_s)
    assert any("more than" in sentence for sentence in simulated_faults(table, figures, PREDICTION_RATIO))


def agrees_by_chance(pool: Passes, table: Table, validated: int, predicted: int) -> list[Table]:
    """Tables whose validated and predicted rms are two samples of one law, drawn from `pool`."""
    rng, tables = np.random.default_rng(4), []
    squares = (np.array(pool.exit_m_s) - table.target_m_s) ** 2
    law = np.array(pool.weight) / math.fsum(pool.weight)
    for _ in range(2000):
        one, other = (rng.choice(squares, count, p=law) for count in (validated, predicted))
        rms, half = math.sqrt(one.mean()), 1.96 * one.std() / one.mean() / 2.0 / math.sqrt(validated)
        interval = (rms * math.exp(-half), rms * math.exp(half))
        tables.append(dataclasses.replace(
            table, validated_rms_m_s=rms, passes=validated, validated_ci95_m_s=interval,
            predicted_rms_m_s=math.sqrt(other.mean()), predicted_passes=predicted, bias_m_s=0.0,
        ))  # fmt: skip
    return tables


def test_a_simulated_prediction_is_not_doubted_for_its_own_chance(many: Passes, table: Table) -> None:
    """With no limits of the ratio to hide behind; were the prediction taken for exact, it would always be doubted."""
    strict = PredictionRatio(1.0, 1.0)
    tables = agrees_by_chance(many, table, 4000, 1000)
    doubted = sum(bool(list(own_faults(each, strict))) for each in tables)
    assert binomial_tail(doubted, len(tables), FALSE_ALARM) > 5e-3
    exact = (dataclasses.replace(each, predicted_passes=None) for each in tables)
    assert sum(bool(list(own_faults(each, strict))) for each in exact) > len(tables) // 4
    halved = (dataclasses.replace(each, predicted_rms_m_s=0.7 * each.predicted_rms_m_s) for each in tables)
    assert all(list(own_faults(each, strict)) for each in halved)


def test_true_claims_of_two_samples_are_not_doubted(many: Passes, table: Table) -> None:
    """Prediction from 300 passes, checked with 300 others, 500 times: both may be off."""
    chance, doubted = Random(2), 0
    columns = tuple(vars(many).values())
    for _ in range(500):
        one, other = (
            figures_of(Passes(*(tuple(column[i] for i in chosen) for column in columns)), table.target_m_s)
            for chosen in (chance.choices(range(len(many.exit_m_s)), k=300) for _ in range(2))
        )
        claimed = dataclasses.replace(
            table, predicted_rms_m_s=one.rms_m_s, bias_m_s=one.bias_m_s, p_overspeed=one.over / one.plain,
            p_stall=one.stalls / one.plain, switchings=one.switchings, predicted_passes=300,
        )  # fmt: skip
        doubted += any(simulated_faults(claimed, other, PREDICTION_RATIO))
    assert binomial_tail(doubted, 500, FALSE_ALARM) > 5e-3
