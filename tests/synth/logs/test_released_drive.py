"""A drive that is open to the air when released: recognised from its log, and then no number is off by it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plant_models.pressure_gauge import PressureGauge
from scripts.studies.identification.truths import GAUGE, TRUTHS, Truth, Yard
from synth.logs import unknowns as asked
from synth.logs.estimate import posterior
from synth.logs.fitting_passes import FittingPasses, fitting_passes
from synth.logs.released_drive import released_drive_vents
from synth.logs.unknowns import unknowns_of
from tuning_tables.pass_log.pass_log import PassLog

AIR_KPA = 15.0

OPEN = Truth(
    "open to the air",
    f"""
[retarder]
stage_pressures_kpa = [0.1, {150 + AIR_KPA}, {300 + AIR_KPA}, {450 + AIR_KPA}, {600 + AIR_KPA}]
[retarder.pneumatics]
supply_pressure_kpa = {700 + AIR_KPA}
exhaust_pressure_kpa = {AIR_KPA}
[retarder.force]
touch_pressure_kpa = {50 + AIR_KPA}
""",
    GAUGE,
)
"""The assumed plant on a scale on which the air has the pressure of its dead band: only there our drive exhausts to the
air, because the edge of the dead band of stage 0 lies at it."""


@pytest.fixture(scope="module")
def vented(yard: Yard) -> FittingPasses:
    """80 passes, on the scale of the assumed plant again."""
    log = yard.passes(OPEN, 80, 7).log
    return fitting_passes(replace(log, pressure_kpa=log.pressure_kpa - AIR_KPA), yard.config.plants(), "test")


def vents(log: PassLog, passes: FittingPasses) -> bool:
    position = passes.plant.position
    return released_drive_vents(log, position.stage_pressures_kpa, position.pneumatics)


def test_both_kinds_of_drive_are_recognised(passes: FittingPasses, vented: FittingPasses) -> None:
    assert vented.released_vents
    assert not passes.released_vents
    for each in (passes, vented):
        for first in range(0, 80, 20):
            assert vents(each.log.taken(np.arange(first, first + 20)), each) == each.released_vents


def test_without_readings_nothing_is_said(vented: FittingPasses) -> None:
    blind = replace(vented.log, pressure_kpa=np.full(len(vented.log.time_s), np.nan))
    assert not vents(blind, vented)
    assert not vents(vented.log.taken([0]), vented)


def one_step(passes: FittingPasses, yard: Yard) -> dict[str, float]:
    """From the true numbers to the most likely ones, by one step, in standard errors."""
    unknowns = unknowns_of(passes, yard.config.parameters)
    keys = tuple(unknown.key for unknown in unknowns)
    truth = TRUTHS[0].values(keys)
    u = np.array([unknown.standing(truth[unknown.key]) for unknown in unknowns])
    there = posterior(passes, unknowns, 2).linearised(u)
    covariance = np.linalg.inv(np.eye(len(u)) + there.information)
    step = covariance @ (there.scores.sum(axis=0) - u) / np.sqrt(np.diag(covariance))
    return dict(zip(keys, step.tolist(), strict=True))


def test_dead_band_and_noise_are_those_of_the_drive(vented: FittingPasses, yard: Yard) -> None:
    right = one_step(vented, yard)
    wrong = one_step(replace(vented, released_vents=False), yard)
    for key in (asked.DEAD_BAND, asked.GAUGE_NOISE):
        assert abs(right[key]) < 4.0
        assert abs(wrong[key]) > 10.0


@pytest.mark.parametrize("noise_kpa", [0.0, 10.0])
def test_noise_of_the_gauge_does_not_mislead(noise_kpa: float, passes: FittingPasses, vented: FittingPasses) -> None:
    z = np.random.default_rng(3).standard_normal(len(vented.log.time_s))
    for each in (passes, vented):
        z = np.resize(z, len(each.log.time_s))
        shown = PressureGauge(noise_kpa, 5.0).reading_kpa(each.log.pressure_kpa, z)
        assert vents(replace(each.log, pressure_kpa=shown), each) == each.released_vents
