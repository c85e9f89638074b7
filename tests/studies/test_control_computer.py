"""The study of the control computer: what it calls a fault, what it keeps for the command, and how it humps."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from scripts.studies.control_computer.benefit import RateEstimates
from scripts.studies.control_computer.comparison import Comparison, joint_factor, judged, verdict
from scripts.studies.control_computer.findings import ControlComputer
from scripts.studies.control_computer.published_speeds import published_speeds
from scripts.studies.control_computer.queues import QueueRun, compared, queue_runs, simulated_run, with_joint_limits
from scripts.studies.control_computer.reliability import DUPLEXES, duplex_point, lives_beside, printed_availability
from scripts.studies.documents import result_of
from synth.computer.economics.hump_rates import RATES, HumpRates
from synth.computer.sizing.demand_service import Discipline

ROOT = Path(__file__).parents[2]
REQUESTS = 30_000


@pytest.fixture(scope="module")
def kept() -> ControlComputer:
    found = result_of(ROOT, "control-computer").findings
    assert isinstance(found, ControlComputer)
    return found


def test_joint_limits_hold_for_all_comparisons_at_once_in_95_of_100_studies() -> None:
    """40 means of 30 batches each, 2000 times; Bonferroni is a little too wide, never too narrow."""
    batches = np.random.default_rng(1).normal(size=(2000, 40, 30))
    half = 2.04523 * batches.std(axis=2, ddof=1) / np.sqrt(30.0)
    inside = (np.abs(batches.mean(axis=2)) <= joint_factor(29, 40) * half).all(axis=1)
    assert 0.94 <= inside.mean() <= 0.97
    assert joint_factor(29, 1) == pytest.approx(1.0)
    assert joint_factor(0, 1) == pytest.approx(1.0)


def test_what_is_not_told_is_not_judged() -> None:
    wrong = Comparison("x", 2.0, 0.0, 1.0, 0.1, 29, 5, told=False)
    right = replace(wrong, formula=1.05, told=True)
    found = judged([wrong, right])
    assert not any(each.outside for each in found)
    assert found[1].limit == pytest.approx(0.1)  # it is the only comparison
    assert verdict(found) == (1, 1, 0)


def run_of(order: Discipline) -> QueueRun:
    """Four tasks under this order."""
    return next(
        replace(run, requests=REQUESTS)
        for run in queue_runs(1000, 4)
        if run.discipline is order and len(run.streams) > 1
    )


@pytest.mark.parametrize("planted", [Discipline.FIRST_COME, Discipline.ABSOLUTE])
def test_a_planted_wrong_formula_of_a_queue_is_outside(planted: Discipline) -> None:
    """The formulas of another order, means and tails."""
    right = run_of(Discipline.RELATIVE)
    found = simulated_run(right)
    assert not any(each.outside for task in with_joint_limits(compared(right, found)) for each in task.comparisons)
    wrong = with_joint_limits(compared(replace(right, discipline=planted), found))
    for part in ("start", "long_start"):
        assert any(getattr(task, part).outside for task in wrong), part


def test_the_printed_duplex_is_outside_and_ours_is_not() -> None:
    point = duplex_point(*DUPLEXES[0], 100_000, 3)
    printed = printed_availability(*DUPLEXES[0])
    wrong = lives_beside("printed", printed, (point.pair.simulated, point.pair.half_width), point.pair.count)
    ours, theirs = judged([point.pair, wrong])
    assert not ours.outside
    assert theirs.outside
    assert theirs.sentence.startswith("printed: the formula tells 7.53")


def test_the_rates_that_the_command_takes_are_there_and_changes_are_their_differences(kept: ControlComputer) -> None:
    variants, beside = kept.benefit.variants, kept.benefit.beside_today
    assert list(variants) == ["today", "asked", "new", "tables"]
    names = list(RATES)
    assert names == [field.name for field in fields(RateEstimates)]
    for name in ("today", "new"):
        HumpRates(**{field: getattr(variants[name].rates, field).value for field in names})
    for name in ("asked", "new"):
        assert variants[name].trains == variants["today"].trains
        for field in names:
            found = getattr(beside[name].change, field)
            difference = getattr(variants[name].rates, field).value - getattr(variants["today"].rates, field).value
            assert found.value == pytest.approx(difference, abs=1e-9), field
            assert found.low95 <= found.value <= found.high95


def test_constant_service_keeps_both_claims_and_the_fewest_stages_do() -> None:
    found = published_speeds()
    assert {law.law: law.kept for law in found.laws}["constant"] == (True, True)
    assert found.faults() == ()
    # an Erlang law of so many stages lies between constant and exponential service
    constant, exponential = found.laws[0].long_share, found.laws[2].long_share
    assert constant < 0.001 < exponential
    assert found.erlang_stages > 2
