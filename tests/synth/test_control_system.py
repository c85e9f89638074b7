"""The nominal loop in python-control against the simulator and against closed forms."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from plant_models import DopplerSensor, Friction, Plant, RollingResistance
from synth.retarder.comparison.baselines import energy_rule, relay
from synth.simulation.closed_loop import Controller, LineController, TableController, close_loop, trace
from synth.simulation.control_system import drive_system, motion_system, nominal_loop, regulator_system
from synth.simulation.nominal_response import SOLVER, nominal_response
from synth.simulation.passes import PassTrace
from synth.simulation.random_passes import random_passes
from synth.solver.switching_lines import SwitchingLines
from synth.solver.tabulate import lines_of
from tests.effort import every
from tests.synth.case_factory import make_table
from tuning_tables import ControllerTable, Stage

control = pytest.importorskip("control")

BRAKED_M = 2 * 12.475
"""Length of both retarders of the pilot plant: every axle is braked over it."""


@pytest.fixture(scope="module")
def quiet(plant_52t: Plant) -> Plant:
    """The pilot plant without chance: no spread of friction and resistance, no sensor noise."""
    return replace(
        plant_52t,
        friction=Friction(common_cv=0.0, axle_cv=0.0, path_std=0.0, correlation_length_m=2.0),
        resistance=RollingResistance(plant_52t.resistance.mean_n_per_kn, 0.0),
        sensor=DopplerSensor(0.0, 0.04, 0.1, 0.02),
    )


def table_for(plant: Plant) -> ControllerTable:
    """A plausible linear table for 3 m/s; a raise or a lower at every stage."""
    pressures = plant.position.stage_pressures_kpa
    lines = (
        Stage(0, pressures[0], None, (4.5, -0.03125)),
        Stage(1, pressures[1], (3.5, -0.015625), (5.25, -0.03125)),
        Stage(2, pressures[2], (4.5, -0.03125), (5.75, -0.046875)),
        Stage(3, pressures[3], (4.75, -0.046875), (6.0, -0.046875)),
        Stage(4, pressures[4], (5.25, -0.046875), None),
    )
    return replace(make_table("test", plant, 3.0), degree=1, stages=lines)


def controller_for(plant: Plant, law: str) -> Controller:
    loop = close_loop(plant, plant.top_stage + 1)
    if law == "table":
        return TableController(table_for(plant))
    if law == "lines, one stage a command":
        return LineController(lines_of(table_for(plant), np.linspace(0.0, plant.exit_m, 2)), farthest=1)
    if law == "energy rule":
        return energy_rule(loop, 3.0, plant.top_stage, 0.9, 0.1, 0.2, 0.1)
    return replace(relay(loop, 3.0, 2, 0.1, 0.0), lead_s=0.3)


def commands_of(events: PassTrace) -> list[tuple[float, int]]:
    changed = np.flatnonzero(np.diff(events.stage)) + 1
    return [(float(events.time_s[i]), int(events.stage[i])) for i in changed]


@pytest.mark.parametrize("law", every(3, ["table", "lines, one stage a command", "energy rule", "relay with lead"]))
def test_passes_are_the_simulators(quiet: Plant, law: str) -> None:
    controller = controller_for(quiet, law)
    passes = random_passes(7, 0, 3)
    switchings = 0
    for i in range(len(passes)):
        events = trace(quiet, controller, passes, i)
        entry = float(quiet.entry.speed_m_s(passes.entry_u)[i])
        found = nominal_response(quiet, controller, entry, float(passes.phase_u[i]) * quiet.sensor.sample_period_s)
        assert [k for _, k in found.commands] == [k for _, k in commands_of(events)]
        assert [t for t, _ in found.commands] == pytest.approx([t for t, _ in commands_of(events)], abs=1e-9)
        assert found.exit_speed_m_s == pytest.approx(events.exit_speed_m_s, abs=0.001)
        assert found.time_s[-1] == pytest.approx(events.time_s[-1], abs=0.002)
        at_samples = ~np.isnan(events.measured_m_s)
        speed = np.interp(events.time_s[at_samples], found.time_s, found.speed_m_s)
        assert speed == pytest.approx(events.speed_m_s[at_samples], abs=0.001)
        switchings += len(found.commands)
    assert switchings >= 6  # the comparison is about something


def test_valves_act_as_the_pressure_relay_asks(quiet: Plant) -> None:
    """From the integrated pressure alone: it rests one dead band beside the stage, on the side it came from."""
    found = nominal_response(quiet, controller_for(quiet, "table"), 6.2, 0.03)
    band, stages = quiet.position.pneumatics.dead_band_kpa, quiet.position.stage_pressures_kpa
    locked = regulator_system(quiet, controller_for(quiet, "table"))
    assert locked.dt == quiet.sensor.sample_period_s
    times = [t for t, _ in found.commands]
    assert len(times) >= 2
    before = 0
    for t, k in found.commands:
        at_command = np.interp(t, found.time_s, found.pressure_kpa)
        # The valve moves after the computing delay and its own delay, and not before.
        delay = 0.02 + 0.1 + (0.2 if k > before and at_command <= 50.0 else 0.0)
        waiting = (found.time_s > t) & (found.time_s < t + delay - 1e-9)
        assert found.pressure_kpa[waiting] == pytest.approx(at_command, abs=1e-3)
        later = (found.time_s > t + delay + 1e-9) & (found.time_s < t + delay + 0.05)
        assert np.all((found.pressure_kpa[later] - at_command) * (k - before) > 0.0)
        before = k
    for (_, k), rest_s in zip(found.commands[:-1], times[1:], strict=True):
        rest = float(np.interp(rest_s, found.time_s, found.pressure_kpa))
        assert abs(rest - stages[k]) == pytest.approx(band, abs=0.01)


def test_held_stage_has_the_closed_form_exit_speed(plant_52t: Plant) -> None:
    """v² = v0² + 2·(g'(i − w)·S_exit − K(P − P0)·4 axles·24.95 m/(Q + 0.42 n)), and no valve moves."""
    pressure, entry = 300.0, 6.0
    inertia = 52.0 + 0.42 * 4
    gravity = 9.81 * 52.0 / inertia * (8.0 - plant_52t.resistance.mean_n_per_kn) * 1e-3 * 37.45
    work = 20.0 / 550.0 * (pressure - 50.0) * 4 * BRAKED_M / inertia
    expected = math.sqrt(entry**2 + 2 * (gravity - work))
    assert expected == pytest.approx(2.6, abs=0.3)  # the brake does matter
    times = np.linspace(0.0, 12.0, 1201)
    response = control.input_output_response(
        nominal_loop(plant_52t), times, np.zeros((1, times.size)), [0.0, entry, pressure],
        solve_ivp_kwargs=SOLVER,
    )  # fmt: skip
    s, v, p = response.outputs
    assert p == pytest.approx(pressure, abs=1e-9)
    assert math.sqrt(np.interp(37.45, s, v**2)) == pytest.approx(expected, abs=5e-4)


def test_friction_and_resistance_are_parameters(plant_52t: Plant) -> None:
    motion = motion_system(plant_52t)
    at, brake = [5.0, 4.0], [350.0]
    coast = motion.dynamics(0.0, at, [40.0])[1]
    nominal = motion.dynamics(0.0, at, brake)[1]
    motion.params = {**motion.params, "friction": 0.5}
    assert motion.dynamics(0.0, at, brake)[1] == pytest.approx(0.5 * (coast + nominal))
    motion.params = {**motion.params, "resistance_n_kn": 8.0}
    assert motion.dynamics(0.0, at, [50.0])[1] == pytest.approx(0.0, abs=1e-12)
    assert list(motion.dynamics(0.0, [5.0, 0.0], brake)) == [0.0, 0.0]


@pytest.mark.parametrize(("valve", "asymptote"), [(1.0, 700.0), (-1.0, 0.0), (0.0, 200.0)])
def test_drive_fills_and_exhausts_exponentially(plant_52t: Plant, valve: float, asymptote: float) -> None:
    times = np.linspace(0.0, 0.6, 13)
    response = control.input_output_response(
        drive_system(plant_52t), times, np.full(13, valve), [200.0], solve_ivp_kwargs={"rtol": 1e-8}
    )
    expected = asymptote + (200.0 - asymptote) * np.exp(-times / 0.3)
    assert response.outputs == pytest.approx(expected, abs=1e-3)


def test_a_stall_is_reported(quiet: Plant) -> None:
    none = np.full((5, 2), np.inf)
    lines = SwitchingLines(np.array([0.0, quiet.exit_m]), -none, np.where(np.arange(5)[:, None] < 4, 0.0, none))
    controller = LineController(lines)
    found = nominal_response(quiet, controller, 5.0, 0.0)
    events = trace(quiet, controller, random_passes(7, 0, 1), 0)
    assert events.stalled
    assert found.stalled
    assert found.exit_speed_m_s == 0.0
    assert 0.0 < found.path_m[-1] < quiet.exit_m
    assert found.speed_m_s[-1] == pytest.approx(0.0, abs=0.01)


def test_python_control_refuses_to_connect_the_sampled_regulator(quiet: Plant) -> None:
    """Why `nominal_response` closes the loop itself; if this ever fails, let python-control do it."""
    systems = [nominal_loop(quiet), regulator_system(quiet, controller_for(quiet, "table"))]
    with pytest.raises(ValueError, match="timebase"):
        control.interconnect(systems, inputs=["valve"], outputs=["stage"])
