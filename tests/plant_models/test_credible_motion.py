"""Limits of credible motion: against closed forms, and never narrower than what simulated cuts do."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Friction, PointSensors, RollingResistance, TrackProfile
from plant_models.credible_motion import SPARE_ACCELERATION_M_S2, credible_motion
from synth.simulation.passage_loop import close_passage_loop
from synth.simulation.random_passes import random_passes
from tests.effort import every
from tests.synth.conftest import pilot_plant
from tests.synth.simulation.passage_cases import SENSORS, braking_rule, with_approach


def test_limits_are_those_of_energy_and_of_the_highest_pressure() -> None:
    plant = replace(
        with_approach(pilot_plant(52.0), 5.0),
        profile=TrackProfile.uniform(12.0),
        friction=Friction(0.0, 0.0, 0.0, 2.0),
        resistance=RollingResistance(1.5, 0.0),
    )
    sensors = PointSensors((-5.0, 10.0), base_m=0.25, base_tolerance=0.01, timer_noise_s=0.0, timer_resolution_s=0.0)
    limits, cut, position = credible_motion(plant, sensors), plant.cut, plant.position
    down = cut.reduced_gravity_m_s2 * 12e-3
    fastest = math.sqrt(position.max_entry_speed_m_s**2 + 2.0 * down * (plant.exit_m + 5.0))
    assert limits.speed_m_s[1] == pytest.approx(1.04 * fastest, rel=1e-3)
    assert limits.speed_tolerance == pytest.approx(0.04, rel=1e-3)
    assert limits.acceleration_m_s2 == pytest.approx(down + SPARE_ACCELERATION_M_S2, rel=1e-12)
    over_kpa = position.stage_pressures_kpa[plant.top_stage] + 15.0 - position.force.touch_pressure_kpa
    held_kn = max(n * position.force.slope_kn_per_kpa(cut, n) for n in range(1, cut.axles + 1)) * over_kpa
    slowed = held_kn / cut.inertia_t + cut.reduced_gravity_m_s2 * 1.5e-3 - down
    assert limits.deceleration_m_s2 == pytest.approx(slowed + SPARE_ACCELERATION_M_S2, rel=1e-12)
    assert limits.path_tolerance_m == pytest.approx(0.35)


@pytest.mark.parametrize("mass_t", every(2, [22.0, 85.0]))
def test_no_simulated_cut_leaves_the_limits(mass_t: float) -> None:
    plant = with_approach(pilot_plant(mass_t), 5.0)
    limits, loop = credible_motion(plant, SENSORS), close_passage_loop(plant, SENSORS, plant.top_stage + 1)
    passes, rule = random_passes(3, 0, 30), braking_rule(plant, SENSORS, 1.0)
    rates = []
    for i in range(30):
        trace = loop.follow(rule, loop.draws(passes.part(i, i + 1)))
        assert trace.speed_m_s.max() < limits.speed_m_s[1]
        lasts = np.diff(trace.time_s)
        rates.append((np.diff(trace.speed_m_s)[lasts > 1e-3]) / lasts[lasts > 1e-3])
    found = np.concatenate(rates)
    assert -limits.deceleration_m_s2 < found.min() < -0.3 * limits.deceleration_m_s2
    assert found.max() < limits.acceleration_m_s2
