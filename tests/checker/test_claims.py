"""Which figures of a table passes confirm, also with an estimator; what a summary says off nominal is read
strictly.
"""

from __future__ import annotations

import dataclasses
import json
import math
import shutil
from collections.abc import Callable
from pathlib import Path
from random import Random
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from synth.checker.claims import PredictionRatio, own_faults, simulated_faults
from synth.checker.coarse_simulation import Passes, simulate
from synth.checker.statistics import FALSE_ALARM, ExitFigures, binomial_tail, figures_of
from synth.checker.summary import KEYS, Summary, by_case, off_nominal_faults, read_summary
from synth.checker.table_reading import Table, read_table
from synth.checker.verdict import verify
from synth.retarder.off_nominal_trials import CONDITIONS
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.passes import ExitSample

PASSES, RMS_M_S = 1000, 0.1


def sure_figures() -> ExitFigures:
    """The same error in each pass, as often too fast as too slow."""
    square = RMS_M_S**2
    return ExitFigures(
        weights=(1.0,) * PASSES,
        squares=(square,) * PASSES,
        mean_square=square,
        square_std=0.0,
        bias_m_s=0.0,
        error_std=RMS_M_S,
        plain=PASSES,
        over=0,
        stalls=0,
        switchings=3.0,
        switchings_std=0.0,
    )


@pytest.mark.parametrize(
    ("predicted_of_simulated", "told"), [(0.7, "more than"), (0.8, ""), (1.0, ""), (1.3, ""), (1.5, "less than")]
)
def test_a_predicted_rms_may_be_off_as_far_as_the_configuration_allows(
    predicted_of_simulated: float, told: str
) -> None:
    claims = SimpleNamespace(
        predicted_rms_m_s=predicted_of_simulated * RMS_M_S,
        validated_rms_m_s=None,
        predicted_passes=None,
        bias_m_s=0.0,
        switchings=3.0,
        p_overspeed=0.0,
        p_stall=None,
    )
    found = list(simulated_faults(claims, sure_figures(), PredictionRatio(0.8, 1.3)))
    assert len(found) == bool(told)
    assert all(sentence.startswith("the predicted rms is") and told in sentence for sentence in found)


@pytest.mark.requirement("VERIFY-06")
def test_the_figures_of_the_same_passes_are_those_of_the_tool() -> None:
    """Exits every millimetre a second from 1 m/s too slow to 1 m/s too fast, after some cuts that stop."""
    exits_m_s = np.concatenate([np.zeros(99), 3.0 + np.linspace(-1.0, 1.0, 2001)])
    stalled, switchings = exits_m_s == 0.0, np.arange(len(exits_m_s), dtype=np.int32) % 7
    ones = np.ones(len(exits_m_s))
    columns = (exits_m_s, stalled, switchings, ones, ones == 1.0)
    found = figures_of(Passes(*(tuple(column.tolist()) for column in columns)), 3.0)
    own = exit_statistics(ExitSample(exits_m_s, stalled, switchings, 9.0 * ones, ones), 3.0)
    shares = found.over / found.plain, found.stalls / found.plain
    assert shares == pytest.approx((own.overspeed, own.stalled))
    assert (found.rms_m_s, found.bias_m_s) == pytest.approx((own.rms_m_s, own.bias_m_s))
    assert found.switchings == pytest.approx(own.switchings)


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


Row = dict[str, Any]
Rows = list[Any]
STATED_PASSES = 4000


@pytest.fixture
def rows(tuned_once: Path) -> Rows:
    """What a tune's summary says of one case off nominal."""
    tables = json.loads((tuned_once / "summary.json").read_text(encoding="utf-8"))["tables"]
    first = tables["cases"][0]["label"], tables["cases"][0]["target_speed_m_s"]
    return by_case(tables["off_nominal"])[first]


def test_the_conditions_of_the_tune_are_those_that_the_checker_asks_for(rows: Rows) -> None:
    assert tuple(each.key for each in CONDITIONS) == KEYS
    assert {row["key"] for row in rows} == set(KEYS)
    assert not list(off_nominal_faults(rows, STATED_PASSES))


def slow_valves(rows: Rows) -> Row:
    """One of the conditions."""
    (found,) = (row for row in rows if row["key"] == "slow_valves")
    return cast(Row, found)


def of(**changes: Any) -> Callable[[Rows], None]:
    return lambda rows: slow_valves(rows).update(changes)


def figure(name: str, **changes: Any) -> Callable[[Rows], None]:
    return lambda rows: slow_valves(rows)[name].update(changes)


FORGED: list[tuple[Callable[[Rows], Any], str]] = [
    (lambda rows: rows.clear(), "must tell of low_friction"),
    (lambda rows: rows.pop(), "must tell of low_friction"),
    (lambda rows: rows.append(dict(rows[0])), "must tell of low_friction"),
    (of(key="sunshine"), "must tell of low_friction"),
    (lambda rows: rows.append([]), "must tell of low_friction"),
    (lambda rows: slow_valves(rows).pop("rms_m_s"), "slow_valves: the document is"),
    (of(more=1), "slow_valves: the document is"),
    (of(rms_m_s="0.1"), "slow_valves: rms_m_s is"),
    (figure("rms_m_s", value=9.0), "slow_valves: rms_m_s is 9.0, which is outside its interval"),
    (figure("stalled", value=0.5), "slow_valves: stalled is 0.5, which is outside"),
    (figure("overspeed", value=1.2, low95=1.1, high95=1.3), "slow_valves: a share above 1"),
    (figure("rms_m_s", low95=0.2, high95=0.1), "slow_valves: rms_m_s is"),
    (figure("ratio", value=99.0), "slow_valves: ratio is 99.0, which is outside"),
    (figure("stalled", n=10**6), "slow_valves: stalled of 1000000 passes, but the table was simulated on 4000"),
    (figure("rms_m_s", n=0), "slow_valves: rms_m_s of 0 passes"),
    (of(impossible="x"), "slow_valves: "),
]


@pytest.mark.parametrize(("forge", "told"), FORGED)
def test_what_cannot_be_is_told(rows: Rows, forge: Callable[[Rows], Any], told: str) -> None:
    forge(rows)
    [sentence] = off_nominal_faults(rows, STATED_PASSES)
    assert told in sentence


def test_a_plant_that_cannot_be_needs_no_figures(rows: Rows) -> None:
    figures = dict.fromkeys(("change", "rms_m_s", "ratio", "overspeed", "stalled"))
    slow_valves(rows).update({**figures, "impossible": "cut: mass_t is too much"})
    assert not list(off_nominal_faults(rows, STATED_PASSES))


def test_verify_reads_it(tuned_once: Path, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    shutil.copytree(tuned_once, folder)
    file = folder / "summary.json"
    document = json.loads(file.read_text(encoding="utf-8"))
    slow_valves(document["tables"]["off_nominal"][: len(KEYS)])["rms_m_s"]["value"] = 9.0
    file.write_text(json.dumps(document), encoding="utf-8")
    told = [finding.sentence for finding in verify(folder, 20, 1).findings]
    assert any("off nominal, slow_valves: rms_m_s is 9.0" in sentence for sentence in told)
