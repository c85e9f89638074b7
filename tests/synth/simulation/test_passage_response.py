"""The nominal loop with point sensors in python-control, against the simulator and against closed forms."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant, PointSensors, every_axle, first_axle
from plant_models.point_sensors import Axles
from synth.simulation.control_system import nominal_loop
from synth.simulation.impulse_train import resting_train
from synth.simulation.nominal_pass import nominal_entry_m_s, nominal_plant, one_pass
from synth.simulation.nominal_response import SAME_PASSAGE_S, commands_of, response_difference
from synth.simulation.passage_loop import PassageLoop, close_passage_loop, filled_trace
from synth.simulation.passage_response import (
    passage_regulator_start,
    passage_regulator_system,
    passage_response,
    rolled,
)
from synth.simulation.passage_sample import PassageTrace
from tests.synth.simulation.passage_cases import CREDIBLE, SENSORS, braking_rule, exact, holding_rule, with_approach

control = pytest.importorskip("control")

TOLERANCE_M_S = 0.001
"""As for a radar: the simulator plays transients in parts of constant pressure."""


@pytest.fixture(scope="module")
def plant(plant_52t: Plant) -> Plant:
    return nominal_plant(with_approach(plant_52t, 5.0))


def simulated(loop: PassageLoop, entry_u: float, limits: tuple[float, ...] = ()) -> PassageTrace:
    controller = braking_rule(loop.plant, loop.sensors, 3.0, limits)
    return loop.follow(controller, loop.draws(one_pass(entry_u, 0.0)))


def test_points_between_events_are_the_simulators(plant: Plant) -> None:
    """With points filled in, the events are still there, and python-control's response runs through every point."""
    sensors = quantised(first_axle)
    loop = close_passage_loop(plant, sensors, plant.top_stage + 1)
    controller = braking_rule(plant, sensors, 3.0)
    draws = loop.draws(one_pass(0.5, 0.0))
    trace = loop.follow(controller, draws)
    filled = filled_trace(loop, trace, draws, 0.05)
    assert set(trace.time_s) <= set(filled.time_s)
    assert np.diff(filled.time_s).max() < 0.05 + 1e-9
    assert np.diff(filled.path_m).min() >= 0.0
    found = passage_response(loop, controller, nominal_entry_m_s(plant, 0.5))
    assert np.interp(filled.time_s, found.time_s, found.path_m) == pytest.approx(filled.path_m, abs=1e-3)
    assert abs(response_difference(found, filled, SAME_PASSAGE_S).largest_m_s) < TOLERANCE_M_S


@pytest.mark.parametrize(("axles", "limits"), [(first_axle, ()), (every_axle, CREDIBLE)])
def test_passes_are_the_simulators(plant: Plant, axles: Axles, limits: tuple[float, ...]) -> None:
    sensors = quantised(axles)
    loop = close_passage_loop(plant, sensors, plant.top_stage + 1)
    controller, commands = braking_rule(plant, sensors, 3.0, limits), 0
    for entry_u in (0.1, 0.5, 0.9):
        trace = simulated(loop, entry_u, limits)
        found = passage_response(loop, controller, nominal_entry_m_s(plant, entry_u))
        difference = response_difference(found, trace, SAME_PASSAGE_S)
        assert difference.parted_s is None
        assert abs(difference.largest_m_s) < TOLERANCE_M_S
        assert found.exit_speed_m_s == pytest.approx(trace.exit_speed_m_s, abs=2e-5)
        assert found.time_s[-1] == pytest.approx(trace.time_s[-1], abs=1e-4)
        told = [t for t, k in zip(trace.readings.time_s, np.diff(trace.readings.stage, prepend=0), strict=True) if k]
        assert [t for t, _ in commands_of(found)] == pytest.approx(told, abs=1e-4)
        commands += len(commands_of(found))
    assert commands >= 7  # the comparison is about something


def quantised(axles: Axles) -> PointSensors:
    """Sensors without chance, but with the resolution of their timer."""
    return replace(SENSORS, timer_noise_s=0.0, base_tolerance=0.0, axles=axles)


def test_without_commands_the_exit_is_that_of_energy(plant: Plant) -> None:
    """v² = v0² + 2·g'·(i − w)·(way), the brake released; the path of each coil is met on the way."""
    sensors = exact(SENSORS)
    loop = close_passage_loop(plant, sensors, plant.top_stage + 1)
    found = passage_response(loop, holding_rule(plant, sensors), 5.5)
    gravity = 9.81 * 52.0 / (52.0 + 0.42 * 4) * 1e-3 * (8.0 - plant.resistance.mean_n_per_kn)
    assert found.exit_speed_m_s == pytest.approx(math.sqrt(5.5**2 + 2.0 * gravity * plant.exit_m), abs=1e-7)
    assert commands_of(found) == ()
    for place in sensors.path_m[1:]:
        for coil in (place - 0.1, place + 0.1):
            assert np.abs(found.path_m - coil).min() < 1e-9


def test_the_impulse_element_finds_the_time_of_a_place(plant: Plant) -> None:
    """Against s = v·t + a·t²/2 with the brake released, wherever the place lies between two points."""
    motion = nominal_loop(plant)
    start = np.array([0.0, -4.0, 5.0, 15.0])
    a = float(motion.dynamics(0.0, start[1:], [0.0])[1])
    for to_m in (-3.99999, -3.9, -1.2345, 3.3):
        points = rolled(motion, start, to_m, resting_train(0.0))
        way = to_m + 4.0
        expected = (math.sqrt(25.0 + 2.0 * a * way) - 5.0) / a
        assert points[0, -1] == pytest.approx(expected, abs=1e-8)
        assert points[1, -1] == to_m
    assert rolled(motion, start, -4.0, resting_train(0.0)).shape == (4, 1)


@pytest.mark.long
def test_a_stall_is_reported(plant: Plant) -> None:
    sensors = quantised(first_axle)
    loop = close_passage_loop(plant, sensors, plant.top_stage + 1)
    hard = braking_rule(plant, sensors, 0.01)
    hard = replace(hard, rule=hard.rule._replace(switching_m_s=np.full_like(hard.rule.switching_m_s, 0.2)))
    found = passage_response(loop, hard, 5.0)
    trace = loop.follow(hard, loop.draws(one_pass(0.0, 0.0)))
    assert trace.stalled
    assert found.stalled
    assert found.exit_speed_m_s == 0.0
    assert found.path_m[-1] == pytest.approx(trace.path_m[-1], abs=0.01)


def test_the_regulator_is_a_discrete_system_of_no_period(plant: Plant) -> None:
    """A pair read while the transient runs is no decision, and leaves the tracker's memory with the passage."""
    sensors = quantised(first_axle)
    loop, controller = (
        close_passage_loop(plant, sensors, plant.top_stage + 1),
        braking_rule(plant, sensors, 3.0, CREDIBLE),
    )
    system, start = passage_regulator_system(loop, controller), passage_regulator_start(loop, controller)
    assert system.dt is True
    over = 0.2 / 6.0
    first = [0.0, over / 2, over, 60.0]
    [stage] = system.output(0.0, start, first)
    assert stage > 0
    memory = system.dynamics(0.0, start, first)
    assert memory[2] > over / 2
    assert memory[3] == 0.0
    since = float(loop.heard.path_m[1] - loop.heard.path_m[0]) / 6.0  # the second axle over the same sensor
    soon = [1.0, over / 2 + since, over, since]
    rests = memory.copy()
    rests[2] = 2.0
    assert list(system.output(0.0, rests, soon)) == [stage]
    assert system.dynamics(0.0, rests, soon)[3] == 1.0
