"""The study of the control computer: what it calls a fault, what it keeps for the command, and how it humps."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from scripts.studies.control_computer.controllers import Controllers, controllers
from scripts.studies.control_computer.failed_hump import FailedPosition, StuckAtStage, failed_trial
from scripts.studies.control_computer.findings import ControlComputer
from scripts.studies.control_computer.hump_runs import HUMPED, first_trains
from scripts.studies.control_computer.published_speeds import published_speeds
from scripts.studies.documents import result_of
from scripts.studies.humping.base_trial import Day
from scripts.studies.humping.runs import Group
from synth.computer.economics.hump_rates import RATES, HumpRates
from synth.hump.trains.made_trial import brake_of
from synth.hump.trains.outcomes import joined
from synth.hump.trains.resolved_trial import load_trial

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def kept() -> ControlComputer:
    found = result_of(ROOT, "control-computer").findings
    assert isinstance(found, ControlComputer)
    return found


def test_the_kept_study_has_no_fault_and_every_planted_one_is_told(kept: ControlComputer) -> None:
    assert kept.faults() == ()
    law = replace(kept.published.speeds.laws[0], long_share=0.01)
    row = replace(kept.controllers.rows[0], in_time=False)
    planted = replace(
        kept,
        published=replace(
            kept.published,
            speeds=replace(kept.published.speeds, laws=(law, *kept.published.speeds.laws[1:])),
        ),
        controllers=replace(kept.controllers, rows=(row, *kept.controllers.rows[1:])),
    )
    faults = planted.faults()
    assert len(faults) == 2
    assert faults[0].startswith("published claims")
    assert faults[1].startswith("PLC")


def test_the_rates_that_the_command_takes_are_there_and_changes_are_their_differences(kept: ControlComputer) -> None:
    variants, beside = kept.benefit.variants, kept.benefit.beside_today
    assert list(variants) == ["today", "asked", "new", "tables"]
    names = list(RATES)
    for name in ("today", "new"):
        HumpRates(**{field: variants[name].rates[field].value for field in names})
    for name in ("asked", "new"):
        assert variants[name].trains == variants["today"].trains
        for field in names:
            found = beside[name].change[field]
            difference = variants[name].rates[field].value - variants["today"].rates[field].value
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
