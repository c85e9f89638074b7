"""The loop in python-control.

The nominal loop in python-control against the simulator.
A table's loop by python-control and by the simulator: how far apart, in which order, and where they may part.
"""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from plant_models import DopplerSensor, Friction, Plant, RollingResistance
from synth.frame.told import plain
from synth.retarder.comparison.baselines import energy_rule, relay
from synth.retarder.estimation.estimator_design import estimator_of
from synth.retarder.loops.control_loop import ENTRIES, TOLERANCE_M_S, LineControlLoop, line_control_loop
from synth.retarder.served_class import ServedClass
from synth.simulation.closed_loop import Controller, LineController, TableController, close_loop, trace
from synth.simulation.control_system import motion_system, nominal_loop, regulator_system
from synth.simulation.nominal_response import (
    commands_of,
    nominal_entry_m_s,
    nominal_pass,
    nominal_plant,
    nominal_response,
    one_pass,
    parting,
    response_difference,
)
from synth.simulation.random_passes import random_passes
from synth.solver.switching_lines import SwitchingLines
from synth.solver.tabulate import lines_of
from tests.effort import every
from tests.synth.case_factory import make_table
from tuning_tables import ControllerTable, Stage

control = pytest.importorskip("control")


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


@pytest.mark.parametrize("law", every(3, ["table", "lines, one stage a command", "energy rule", "relay with lead"]))
def test_passes_are_the_simulators(quiet: Plant, law: str) -> None:
    controller = controller_for(quiet, law)
    passes = random_passes(7, 0, 3)
    switchings = 0
    for i in range(len(passes)):
        events = trace(quiet, controller, passes, i)
        entry = float(quiet.entry.speed_m_s(passes.entry_u)[i])
        found = nominal_response(quiet, controller, entry, float(passes.phase_u[i]) * quiet.sensor.sample_period_s)
        assert [k for _, k in commands_of(found)] == [k for _, k in commands_of(events)]
        assert [t for t, _ in commands_of(found)] == pytest.approx([t for t, _ in commands_of(events)], abs=1e-9)
        assert found.exit_speed_m_s == pytest.approx(events.exit_speed_m_s, abs=0.001)
        assert found.time_s[-1] == pytest.approx(events.time_s[-1], abs=0.002)
        at_samples = ~np.isnan(events.measured_m_s)
        speed = np.interp(events.time_s[at_samples], found.time_s, found.speed_m_s)
        assert speed == pytest.approx(events.speed_m_s[at_samples], abs=0.001)
        switchings += len(commands_of(found))
    assert switchings >= 6  # the comparison is about something


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


pytest.importorskip("control")


@pytest.fixture(scope="module")
def loop(plant_52t: Plant) -> LineControlLoop:
    """The loop of a plausible table."""
    return line_control_loop(table_for(plant_52t), ServedClass("gondola", plant_52t))


def test_the_nominal_plant_has_no_chance_left(plant_52t: Plant) -> None:
    """Passes that differ in every random number but entry and phase end alike; on the real plant they do not."""
    one = one_pass(0.5, 0.5)
    other = replace(one, cut_z=one.cut_z + 2.0, resistance_u=0.9 * one.weight, noise_z=one.noise_z + np.float32(1.0))
    exits = {}
    for name, plant in (("nominal", nominal_plant(plant_52t)), ("real", plant_52t)):
        law = TableController(table_for(plant))
        closed = close_loop(plant, law.stages)
        exits[name] = {float(closed.run(law, closed.draws(passes)).exit_speed_m_s[0]) for passes in (one, other)}
    assert (len(exits["nominal"]), len(exits["real"])) == (1, 2)


@pytest.mark.parametrize("entry_u", [0.1, 0.5, 0.9])
def test_a_table_with_estimator_is_followed_too(plant_52t: Plant, entry_u: float) -> None:
    """The estimator's own text runs in both; in python-control on the pressure that is integrated there."""
    plant = replace(
        plant_52t, sensor=replace(plant_52t.sensor, resolution_m_s=0.5)
    )  # coarse: there is much to estimate
    without_it = TableController(table_for(plant))
    law = TableController(replace(table_for(plant), estimator=estimator_of(plant)))
    phase_s = 0.3 * plant.sensor.sample_period_s
    response = nominal_response(plant, law, nominal_entry_m_s(plant, entry_u), phase_s)
    found = response_difference(response, nominal_pass(plant, law, entry_u, 0.3))
    assert found.parted_s is None
    assert abs(found.largest_m_s) < TOLERANCE_M_S
    without = nominal_pass(plant, without_it, entry_u, 0.3)
    assert abs(response.exit_speed_m_s - without.exit_speed_m_s) > TOLERANCE_M_S  # so the estimator does something


def test_the_loop_agrees_and_its_document_is_plain(loop: LineControlLoop) -> None:
    assert loop.agrees
    assert loop.difference.parted_s is None
    assert len(loop.portrait) == ENTRIES
    entries = [float(response.speed_m_s[0]) for response in loop.portrait]
    assert entries == sorted(entries)
    document = json.loads(json.dumps(plain(loop.document), allow_nan=False))
    assert document["difference"]["agrees"] is True
    assert document["python_control"]["commands"] == [list(each) for each in commands_of(loop.response)]
    assert document["simulator"]["exit_speed_m_s"] == loop.trace.exit_speed_m_s
    assert len(document["limit_cycles"]) == len(loop.hunting)


def test_a_difference_is_found(loop: LineControlLoop) -> None:
    """Planted: a pass that is 5 mm/s faster for a moment, and one that commands another stage from a sample on."""
    trace = loop.trace
    bump = np.where(np.arange(trace.time_s.size) == trace.time_s.size // 2, 0.005, 0.0)
    apart = response_difference(loop.response, replace(trace, speed_m_s=trace.speed_m_s + bump))
    assert apart.largest_m_s == pytest.approx(-0.005, abs=TOLERANCE_M_S)
    assert not replace(loop, trace=replace(trace, speed_m_s=trace.speed_m_s + bump)).agrees
    later = replace(trace, stage=np.where(trace.time_s > 0.6 * trace.time_s[-1], 4, trace.stage))
    parted = response_difference(loop.response, later)
    assert parted.parted_s is not None
    assert 0.0 < parted.parted_s < trace.time_s[-1]
    assert abs(parted.largest_m_s) <= TOLERANCE_M_S  # what comes after the parting does not count


@pytest.mark.parametrize(
    ("one", "other", "at"),
    [
        ((), (), None),
        (((0.1, 1),), ((0.1 + 1e-9, 1),), None),
        (((0.1, 1), (0.5, 2)), ((0.1, 1), (0.6, 2)), 0.5),
        (((0.1, 1), (0.5, 2)), ((0.1, 1), (0.5, 0)), 0.5),
        (((0.1, 1), (0.5, 2)), ((0.1, 1),), 0.5),
        (((0.1, 1),), ((0.1, 1), (0.7, 2)), 0.7),
    ],
)
def test_commands_part_where_they_first_differ(
    one: tuple[tuple[float, int], ...], other: tuple[tuple[float, int], ...], at: float | None
) -> None:
    assert parting(one, other) == at
    assert parting(other, one) == at
