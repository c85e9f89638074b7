"""What a tune for point sensors says of brake power, of passages, and of the limits of a configuration."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from plant_models import every_axle
from plant_models.point_sensors import Axles
from synth.retarder.acceptance import CaseVerdict, judge_case
from synth.retarder.configuration.settings import AcceptanceSettings
from synth.retarder.sensors.sensor_case import HeardShares, SensorCase, heard_shares, unavoidable
from synth.retarder.sensors.sensor_class import SensorPasses, full_brake, sensor_passes
from synth.simulation.exit_statistics import BrakePower, exit_statistics
from synth.simulation.passage_sample import DECIDED, NO_DECISION, NOT_BELIEVED, NOT_HEARD, UNFINISHED, PassageSample
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import random_passes
from synth.simulation.unavoidable_error import UnavoidableError
from synth.solver.descent import Descent
from synth.solver.exit_density import ExitDensity
from synth.solver.passage_speeds import PassageSpeeds
from tests.controller_code.passage_tables import passage_table
from tests.synth.conftest import pilot_plant
from tests.synth.simulation.passage_cases import SENSORS, braking_rule, holding_rule, with_approach

COUNT = 400


@pytest.fixture(scope="module")
def passes() -> SensorPasses:
    """A light cut that may be given stage 2 at the entrance."""
    plant = with_approach(pilot_plant(36.0), 5.0, entrance_stage=2)
    return sensor_passes(plant, SENSORS, random_passes(1, 0, COUNT))


def test_full_brake_goes_to_the_highest_stage_allowed_at_once(passes: SensorPasses) -> None:
    top = passes.loop.plant.top_stage
    for index in range(5):
        found = passes.trace(full_brake(passes.loop), index, 1.0)
        read = found.readings
        assert (read.outcome == DECIDED)[0]
        assert read.stage[0] == 2  # as much as may be given before the entrance
        behind = found.path_m > SENSORS.path_m[1] + SENSORS.base_m
        assert set(found.stage[behind].tolist()) == {top}


@pytest.mark.parametrize("axles", [SENSORS.axles, every_axle])
def test_no_rule_slows_down_a_cut_more_than_full_brake(axles: Axles) -> None:
    plant = with_approach(pilot_plant(66.0), 5.0)  # may be given all stages
    sensors = replace(SENSORS, axles=axles)
    found = sensor_passes(plant, sensors, random_passes(2, 0, COUNT))
    least = found.at_full_brake.exit_speed_m_s
    for rule in (holding_rule(plant, sensors), braking_rule(plant, sensors, 2.0), braking_rule(plant, sensors, 4.0)):
        assert (found.run(rule).exit_speed_m_s >= least - 1e-9).all()


def exits(speeds_m_s: np.ndarray) -> ExitSample:
    """Cuts that left with these speeds."""
    n = len(speeds_m_s)
    return ExitSample(speeds_m_s, speeds_m_s == 0.0, np.zeros(n, np.int32), np.ones(n), np.ones(n))


def test_what_no_table_can_avoid_is_the_excess_of_the_slower_of_two(passes: SensorPasses) -> None:
    """The table is slower in every other pass; nothing brakes cuts that are released."""
    braked, free = passes.at_full_brake.exit_speed_m_s, passes.released.exit_speed_m_s
    assert (passes.released.switchings == 0).all()
    assert (free > braked).all()
    slower = np.where(np.arange(COUNT) % 2 == 0, braked - 0.3, braked + 0.3)
    target = float(np.median(braked)) - 0.1
    found = unavoidable(passes, exits(slower), target)
    excess = np.maximum(np.minimum(slower, braked) - target, 0.0)
    assert found.rms_m_s == pytest.approx(math.sqrt(float(np.mean(excess**2))))
    assert found.rms_ci95_m_s[0] <= found.rms_m_s <= found.rms_ci95_m_s[1]
    assert found.too_fast
    too_slow = unavoidable(passes, exits(slower), 9.0)
    assert too_slow.rms_m_s == pytest.approx(math.sqrt(float(np.mean((9.0 - free) ** 2))))
    assert not too_slow.too_fast


def test_shares_are_of_the_cuts_that_come_to_a_passage() -> None:
    first = np.resize([DECIDED, UNFINISHED, DECIDED, NOT_BELIEVED], 400)
    last = np.resize([NOT_HEARD, NOT_HEARD, NO_DECISION, DECIDED], 400)
    never = np.full(400, NOT_HEARD)
    outcome = np.stack([first, last, never], axis=1).astype(np.uint8)
    sample = PassageSample(**vars(exits(np.full(400, 2.0))), outcome=outcome)
    found = heard_shares(sample)
    assert [share for share, _ in found.mistaken[:2]] == pytest.approx([0.25, 0.5])
    assert found.unfinished[0][0] == pytest.approx(1.0 / 3.0)  # of those that were believed
    assert math.isnan(found.mistaken[2][0])
    assert math.isnan(found.unfinished[2][0])


def case(spread_m_s: float, least: float, ci95: tuple[float, float]) -> SensorCase:
    """A case with normal errors, predicted as simulated."""
    error = spread_m_s * np.random.default_rng(7).standard_normal(4000)
    table = passage_table(target_m_s=2.5)
    found = exit_statistics(exits(2.5 + error), 2.5)
    return SensorCase(
        label="made",
        plant=with_approach(pilot_plant(22.0), 5.0),
        table=replace(table, predicted=replace(table.predicted, rms_m_s=found.rms_m_s)),
        predicted=ExitDensity(np.array([0.0, 2.5]), np.array([0.0, 1.0]), 0.0, 0.0, 4.0),
        polish=Descent(PassageSpeeds(np.zeros((1, 2, 1))), 1.0, 0.5, 9, True, "done"),
        exit_speeds_m_s=(2.5 + error).astype(np.float32),
        exit_weight=np.ones(4000),
        statistics=found,
        brake_power=BrakePower(0.0, (0.0, 0.001), found.rms_m_s, found.rms_ci95_m_s),
        unavoidable=UnavoidableError(least, ci95, too_fast=True),
        heard=HeardShares((), (), (), ()),
        traces=(),
    )


LIMITS = AcceptanceSettings(rms_m_s=0.1)


def verdict(spread_m_s: float, least: float = 0.0, ci95: tuple[float, float] = (0.0, 0.0)) -> CaseVerdict:
    """That on a case."""
    return judge_case(case(spread_m_s, least, ci95), LIMITS)


def test_a_case_is_judged_by_the_limits_unless_the_brake_alone_misses_them() -> None:
    assert verdict(0.08).word == "accepted"
    assert verdict(0.13).word == "missed"
    assert verdict(0.10).word == "not decidable"
    assert verdict(0.13, 0.06, (0.05, 0.07)).word == "missed"  # there is brake enough
    short = verdict(0.3, 0.12, (0.11, 0.13))
    assert (short.word, short.obstacle) == ("infeasible", "brake saturated")
    unsure = verdict(0.3, 0.1, (0.09, 0.11))
    assert unsure.word == "not decidable"
    assert "too near to the limit to tell whether the case is feasible" in unsure.judgement.undecided[-1]
    assert verdict(0.08, 0.1, (0.09, 0.11)).word == "accepted"


def test_warnings_tell_of_a_polish_cut_short_and_of_escaped_probability() -> None:
    plain = case(0.08, 0.0, (0.0, 0.0))
    assert plain.warnings == ()
    doubtful = replace(
        plain,
        polish=replace(plain.polish, converged=False, status="Iteration limit reached"),
        predicted=replace(plain.predicted, escaped=1e-3),
    )
    assert "Iteration limit reached" in doubtful.warnings[0]
    assert "lower grid.speed_step_m_s" in doubtful.warnings[1]
