"""The study of the control computer: what it calls a fault, what it keeps for the command, and how it humps."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from scripts.studies.control_computer.benefit import RateEstimates
from scripts.studies.control_computer.comparison import Comparison, joint_factor, judged, verdict
from scripts.studies.control_computer.controllers import Controllers, controllers
from scripts.studies.control_computer.failed_hump import FailedPosition, StuckAtStage, failed_trial
from scripts.studies.control_computer.findings import ControlComputer
from scripts.studies.control_computer.hump_runs import HUMPED, first_trains
from scripts.studies.control_computer.published_speeds import published_speeds
from scripts.studies.control_computer.queues import QueueRun, compared, queue_runs, simulated_run, with_joint_limits
from scripts.studies.control_computer.reliability import DUPLEXES, duplex_point, lives_beside, printed_availability
from scripts.studies.documents import result_of
from scripts.studies.humping.base_trial import Day
from scripts.studies.humping.runs import Group
from synth.computer.economics.hump_rates import RATES, HumpRates
from synth.computer.sizing.demand_service import Discipline
from synth.hump.trains.made_trial import brake_of
from synth.hump.trains.outcomes import joined
from synth.hump.trains.resolved_trial import load_trial

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


def test_the_kept_study_has_no_fault_and_every_planted_one_is_told(kept: ControlComputer) -> None:
    assert kept.faults() == ()
    task = kept.queues.tasks[0]
    bad = replace(task, start=replace(task.start, formula=1.1 * task.start.formula))
    duplex = kept.reliability.duplexes[0]
    pair = replace(duplex, pair=replace(duplex.pair, formula=duplex.printed))
    root = replace(kept.reliability.intervals[0], root_h=2.0)
    law = replace(kept.published.speeds.laws[0], long_share=0.01)
    row = replace(kept.controllers.rows[0], in_time=False)
    planted = replace(
        kept,
        queues=replace(kept.queues, tasks=(bad, *kept.queues.tasks[1:])),
        reliability=replace(
            kept.reliability,
            duplexes=(pair, *kept.reliability.duplexes[1:]),
            intervals=(root, *kept.reliability.intervals[1:]),
        ),
        published=replace(
            kept.published,
            speeds=replace(kept.published.speeds, laws=(law, *kept.published.speeds.laws[1:])),
        ),
        controllers=replace(kept.controllers, rows=(row, *kept.controllers.rows[1:])),
    )
    faults = planted.faults()
    assert len(faults) == 5
    starts = ("four tasks, first come", "duplex, λ 0.01/h", "published claims", "best interval", "PLC")
    assert [fault.startswith(start) for fault, start in zip(faults, starts, strict=True)] == [True] * 5


def test_every_queue_keeps_a_million_requests(kept: ControlComputer) -> None:
    assert min(task.kept for task in kept.queues.tasks) >= 1_000_000
    assert {task.order for task in kept.queues.tasks} == {"first come", "relative", "absolute"}
    told, own, outside = verdict(kept.queues.comparisons)
    assert outside == 0
    assert own / told >= 0.85  # 95 % intervals, many of the same requests


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


def test_controllers_do_not_contradict_themselves() -> None:
    found = controllers()
    assert found.faults() == ()
    most = {limit.controller: limit.most for limit in found.limits}
    wrong = Controllers(
        found.answer_deadline_s, found.table_deadline_s, found.rows,
        tuple(replace(limit, most=most[limit.controller] // 100) for limit in found.limits),
    )  # fmt: skip
    assert len(wrong.faults()) > 0


@pytest.mark.long
def test_trains_are_humped_alike_whatever_the_batch_and_the_plan_is_shared() -> None:
    """A failure after the plan: the group's trial is that of the trial by itself."""
    config = load_trial(None)
    brakes = [brake_of(each, config) for each in config.positions]
    sound = Day(seed=3, cuts=8, design_cuts=200).trial()
    stuck = failed_trial(sound, brakes, [FailedPosition(1, StuckAtStage(4))])
    group = Group({"sound": sound, "stuck": stuck})
    whole = group.batch(0, 4, HUMPED)
    halves = [group.batch(first, 2, HUMPED) for first in (0, 2)]
    for k, trial in enumerate((sound, stuck)):
        alone = trial.batch(0, 4)
        for parts in (whole[k].outcomes, joined([half[k].outcomes for half in halves])):
            np.testing.assert_array_equal(parts.overspeed, alone.overspeed)
            np.testing.assert_array_equal(parts.gap_m, alone.gap_m)
    assert (whole[0].before_stop == 8).all()
    assert (whole[1].before_stop < 8).any()
    assert first_trains(whole[0].outcomes, 2).train.tolist() == [0, 1]
