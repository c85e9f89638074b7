"""Motion: braked wheel pairs, exact cell means, work, credible limits, and what is said once of the plant."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plant_models import (
    Car,
    Cut,
    DopplerSensor,
    Friction,
    Pneumatics,
    PointSensors,
    PressingForce,
    RetarderPosition,
    RollingResistance,
    TrackProfile,
    couple,
    path_coefficients,
)
from plant_models.motion import braked_axles, mean_braked_axles, path_breaks_m
from plant_models.point_sensors import SPARE_ACCELERATION_M_S2, credible_motion
from synth.simulation.passage_loop import close_passage_loop
from synth.simulation.random_passes import random_passes
from tests.effort import every, sized
from tests.synth.conftest import pilot_plant
from tests.synth.simulation.passage_cases import SENSORS, braking_rule, with_approach

DRIVE = Pneumatics(700.0, 0.0, 0.1, 0.2, 0.1, 0.3, 0.3, 15.0)
LENGTH_M = 12.475
GONDOLA = Cut("Т", 85.0, (0.0, 1.85, 8.65, 10.5), 4)
STAGES_KPA = (0.0, 150.0, 300.0, 450.0, 600.0)


def position(*zones: tuple[float, float], factors: tuple[float, ...] = (1.0,)) -> RetarderPosition:
    return RetarderPosition("test", zones, STAGES_KPA, PressingForce(20 / 550, 50.0, factors), DRIVE, 7.0)


ONE = position((0.0, LENGTH_M))
TWO = position((0.0, LENGTH_M), (LENGTH_M + 2.0, 2 * LENGTH_M + 2.0))
FLAT = TrackProfile.uniform(0.0)


def test_braked_axles_table_of_the_facts() -> None:
    edges = [0, 1.85, 8.65, 10.50, 12.475, 14.325, 21.125, 22.975]
    np.testing.assert_allclose(path_breaks_m(ONE, GONDOLA, FLAT), edges)
    middle = 0.5 * (np.array(edges[1:]) + np.array(edges[:-1]))
    assert braked_axles(ONE, GONDOLA, middle).tolist() == [1, 2, 3, 4, 3, 2, 1]
    short, pair = position((0.0, 2.0)), Cut("Т", 40.0, (0.0, 1.0), 4)
    assert braked_axles(short, pair, np.arange(4.0)).tolist() == [1, 2, 1, 0]  # out where the zone ends
    assert ONE.exit_m(GONDOLA) == pytest.approx(LENGTH_M + 10.5)


def test_mean_braked_axles_of_the_facts() -> None:
    assert mean_braked_axles(ONE, GONDOLA) == pytest.approx(4 * LENGTH_M / 22.975)
    assert mean_braked_axles(ONE, GONDOLA) == pytest.approx(2.17, abs=0.005)


def test_energy_head_follows_from_the_force() -> None:
    """F = Q·g·h/(4·L): 20 kN on each wheel pair takes 1.2 m of head from a car of 85 t."""
    edges = path_breaks_m(ONE, GONDOLA, FLAT)
    c = path_coefficients(ONE, GONDOLA, FLAT, edges)
    work_kj = float((c.brake_m_s2_per_kpa * np.diff(edges)).sum()) * 550.0 * GONDOLA.inertia_t
    assert work_kj == pytest.approx(4 * 20.0 * LENGTH_M)
    assert work_kj / (85.0 * 9.81) == pytest.approx(1.2, abs=0.005)


@pytest.mark.parametrize(("mass_t", "deceleration"), [(22, 3.38), (36, 2.12), (52, 1.49), (85, 0.92)])
def test_deceleration_table_of_the_facts(mass_t: float, deceleration: float) -> None:
    cut = Cut("С", mass_t, GONDOLA.axle_offsets_m, 4)
    c = path_coefficients(ONE, cut, FLAT, np.array([11.0, 12.0]))
    assert float(c.brake_m_s2_per_kpa[0]) * 550.0 == pytest.approx(deceleration, abs=0.006)


@settings(max_examples=sized(10, 40), deadline=None, derandomize=True)
@given(cells=st.integers(3, 200), cars=st.integers(1, 3))
def test_work_does_not_depend_on_the_cells(cells: int, cars: int) -> None:
    cut = couple((Car("g", GONDOLA.axle_offsets_m, 13.92, 22.0, 94.0),) * cars, 50.0 * cars, "С", 4)
    profile = TrackProfile((0.0, 9.0, 20.0), (12.0, 8.0, 1.5))
    edges = np.linspace(0.0, TWO.exit_m(cut), cells + 1)
    c = path_coefficients(TWO, cut, profile, edges)
    brake_m = float((c.brake_m_s2_per_kpa * np.diff(edges)).sum()) * cut.inertia_t / (20 / 550)
    assert brake_m == pytest.approx(4 * cars * 2 * LENGTH_M)
    breaks = path_breaks_m(TWO, cut, profile)
    fine = path_coefficients(TWO, cut, profile, breaks)
    assert (c.gravity_m_s2 * np.diff(edges)).sum() == pytest.approx((fine.gravity_m_s2 * np.diff(breaks)).sum())


def test_gravity_and_resistance_coefficients() -> None:
    c = path_coefficients(ONE, GONDOLA, TrackProfile.uniform(8.0), np.array([0.0, 5.0, 22.975]))
    np.testing.assert_allclose(c.gravity_m_s2, 8e-3 * 9.81 * 85 / 86.68)
    assert c.resistance_m_s2_per_n_kn == pytest.approx(1e-3 * 9.81 * 85 / 86.68)


def test_grade_is_the_mean_under_the_axles() -> None:
    """First axle past the break, the other three before it: a quarter of the drop is felt."""
    profile = TrackProfile((0.0, 10.0), (8.0, 4.0))
    c = path_coefficients(ONE, GONDOLA, profile, np.array([10.0, 11.0]))
    assert float(c.gravity_m_s2[0]) == pytest.approx(7e-3 * GONDOLA.reduced_gravity_m_s2)
    assert profile.grade_permille(np.array([-1.0, 0.0, 9.9, 10.0, 99.0])).tolist() == [8.0, 8.0, 8.0, 4.0, 4.0]


def test_slope_factor_depends_on_the_number_of_braked_axles() -> None:
    edges = np.array([0.0, 1.85, 8.65, 10.5, 12.475])
    plain = path_coefficients(ONE, GONDOLA, FLAT, edges).brake_m_s2_per_kpa
    factored = position((0.0, LENGTH_M), factors=(1.0, 0.9, 0.8))
    got = path_coefficients(factored, GONDOLA, FLAT, edges).brake_m_s2_per_kpa
    np.testing.assert_allclose(got / plain, [1.0, 0.9, 0.8, 0.8])


def test_coefficients_are_read_only() -> None:
    c = path_coefficients(ONE, GONDOLA, FLAT, np.array([0.0, 5.0]))
    with pytest.raises(ValueError, match="read-only"):
        c.brake_m_s2_per_kpa[0] = 1.0


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


def test_std_of_a_reading_adds_noise_and_the_uniform_law_of_rounding() -> None:
    seen = DopplerSensor(0.03, 0.12, 0.1, 0.0)
    assert seen.reading_std_m_s == pytest.approx(math.sqrt(0.03**2 + 0.12**2 / 12.0))
    exact = DopplerSensor(0.0, 0.0, 0.1, 0.0)
    assert exact.exact
    assert exact.reading_std_m_s == 1e-4
    assert not seen.exact


def test_std_of_a_reading_is_that_of_simulated_readings() -> None:
    rng = np.random.default_rng(3)
    v = rng.uniform(2.0, 6.0, 400_000)
    sensor = DopplerSensor(0.03, 0.12, 0.1, 0.0)
    readings = np.round((v + sensor.noise_m_s * rng.standard_normal(v.size)) / 0.12) * 0.12
    assert float(np.std(readings - v)) == pytest.approx(sensor.reading_std_m_s, rel=0.005)


def test_a_cut_rolls_freely_where_grade_and_resistance_are_equal() -> None:
    valves = Pneumatics(700.0, 0.0, 0.1, 0.2, 0.1, 0.3, 0.3, 15.0)
    position = RetarderPosition("x", ((0.0, 10.0),), (0.0, 300.0), PressingForce(0.03, 50.0), valves, 7.0)
    cut = Cut("x", 80.0, (0.0, 1.85, 8.65, 10.5), 1)
    cells = path_coefficients(position, cut, TrackProfile.uniform(2.5), np.linspace(0.0, 20.5, 5))
    np.testing.assert_allclose(cells.free_m_s2(2.5), 0.0, atol=1e-15)
    np.testing.assert_allclose(cells.free_m_s2(1.5), 9.81 * 80.0 / (80.0 + 0.42 * 4) * 1e-3)


def test_a_valve_opens_after_its_own_delay() -> None:
    valves = Pneumatics(700.0, 0.0, 0.11, 0.2, 0.07, 0.31, 0.4, 15.0)
    for start, end, delay in ((0.0, 300.0, 0.31), (50.0, 300.0, 0.31), (135.0, 300.0, 0.11), (285.0, 0.0, 0.07)):
        assert valves.respond(start, end, 50.0).starts_s[1] == pytest.approx(delay)
