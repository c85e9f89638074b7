"""Passes beside the loop: in python-control, commanded from outside, and by a table.

The nominal loop with point sensors in python-control, against the simulator.
A pass that is commanded from outside, sample by sample, against the kernels of the closed loop.
A table for point sensors in the loop: hearing every axle it commands what it commands when told its passages.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant, PointSensors, every_axle, first_axle
from plant_models.point_sensors import Axles
from synth.kernels.loop.passage_pulses import Pair
from synth.kernels.loop.passage_regulator import begin_cut, stage_after_pair
from synth.problem.criterion import Criterion
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.retarder.bench.run import TableShadow
from synth.retarder.sensors.passage_table import passage_chains, passage_table, tuned_passages
from synth.simulation.closed_loop import TableController, close_loop
from synth.simulation.nominal_response import (
    SAME_PASSAGE_S,
    commands_of,
    nominal_entry_m_s,
    nominal_plant,
    one_pass,
    response_difference,
)
from synth.simulation.passage_controller import UNFINISHED, PassageTrace, of_table
from synth.simulation.passage_loop import PassageLoop, close_passage_loop, filled_trace
from synth.simulation.passage_response import passage_regulator_start, passage_regulator_system, passage_response
from synth.simulation.random_passes import random_passes
from synth.simulation.sampled_pass import PassEnd, SampledPass, sampled_pass
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.chain.sampling import with_point_sensors
from tests.controller_code.fmi.test_position_unit import CASES, Case
from tests.effort import sized
from tests.synth.conftest import pilot_plant
from tests.synth.simulation.passage_cases import CREDIBLE, SENSORS, braking_rule, with_approach
from tuning_tables import ControllerTable, Generator
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.rule import held_by
from tuning_tables.programs import at_pulse, tracker

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


PASSES, SEED = sized(12, 300), 3
TOLERANCE = 1e-10
"""m/s and s. Both compute the same in double precision, in another order: 4e-12 were measured in 100 passes."""


@pytest.mark.parametrize("case", CASES.values(), ids=list(CASES))
def test_under_the_stages_of_a_table_it_ends_as_in_the_simulator(case: Callable[[], Case]) -> None:
    plant, table = case()
    loop = close_loop(plant, len(table.stages))
    draws = loop.draws(random_passes(SEED, 0, PASSES))
    simulated = loop.run(TableController(table), draws)
    for i in range(PASSES):
        end, commands = driven(sampled_pass(loop, draws.part(i, i + 1)), table)
        assert end.exit_speed_m_s == pytest.approx(simulated.exit_speed_m_s[i], abs=TOLERANCE)
        assert end.time_s == pytest.approx(simulated.transit_time_s[i], abs=TOLERANCE)
        assert end.stalled == simulated.stalled[i]
        assert commands == simulated.switchings[i]


def driven(rolling: SampledPass, table: ControllerTable) -> tuple[PassEnd, int]:
    """The end under `table`, and how many commands it gave."""
    asked, reading, commands = TableShadow(table), next(rolling), 0
    while True:
        stage = asked.stage_at(reading)
        commands += stage != reading.stage
        try:
            reading = rolling.send(stage)
        except StopIteration as ended:
            return ended.value, commands


COARSE = Resolution(path_step_m=1.0, speed_step_m_s=0.1, friction_nodes=3, path_levels=1, resistance_nodes=1)


def solved(mass_t: float, axles: Axles, resolution: Resolution = COARSE) -> tuple[PassageTable, PassageLoop]:
    """A table as it is exported, and the loop of its plant and sensors."""
    sensors = PointSensors((-8.0, 10.0, 18.0, 24.0, 29.0, 33.0, 39.0), axles=axles)
    plant = with_point_sensors(pilot_plant(mass_t), sensors)
    tuned = tuned_passages(passage_chains(plant, sensors, resolution), Aim(3.0, Criterion()))
    table = passage_table(tuned, Generator("retarder-synth", "0", "0" * 64), "t", "2026-11-22T00:00:00Z")
    return table, close_passage_loop(plant, sensors, len(table.pressure_kpa))


@pytest.mark.parametrize(("mass_t", "axles"), [(22.0, every_axle), (52.0, first_axle)])
def test_hearing_every_axle_commands_what_being_told_commands(mass_t: float, axles: Axles) -> None:
    table, loop = solved(mass_t, axles)
    assert list(table.heard_path_m[: len(loop.heard.path_m)]) == list(loop.heard.path_m.astype(np.float32))
    assert list(table.heard_passage[: len(loop.heard.path_m)]) == list(loop.heard.decides)
    draws = loop.draws(stratified_passes(5, 0, 600))
    told, tracked = loop.run(of_table(table, False), draws), loop.run(of_table(table, True), draws)
    assert np.array_equal(tracked.switchings, told.switchings)
    assert np.array_equal(tracked.outcome, told.outcome)
    np.testing.assert_allclose(tracked.exit_speed_m_s, told.exit_speed_m_s, rtol=1e-9)
    assert tracked.switchings.mean() > 0.5
    passes = random_passes(7, 0, 10)
    for i in range(10):
        drawn = loop.draws(passes.part(i, i + 1))
        one, other = (loop.follow(of_table(table, tracks), drawn).readings for tracks in (False, True))
        here = np.isin(other.passage, one.passage)
        assert list(other.passage) == list(other.believed)
        assert list(one.stage) == list(other.stage[here])


def test_the_kernel_runs_the_step_of_a_controller() -> None:
    """The pairs of a pass, given to the step as Python runs it: the same stages, pair by pair, and the same belief."""
    table, loop = solved(52.0, first_axle)
    held, passes = held_by(table), random_passes(7, 0, 4)
    for i in range(4):
        heard = loop.follow(of_table(table, True), loop.draws(passes.part(i, i + 1))).readings
        state, compiled = np.zeros(6, dtype=np.float32), np.ones(6, dtype=np.float32)
        tracker.begin_cut(state)
        begin_cut(compiled)
        before_s, stage = -60.0, table.initial_stage
        for at, time_s in enumerate(heard.time_s):
            over_s = table.sensors.base_m / heard.reading_m_s[at]
            ended = bool(heard.outcome[at] != UNFINISHED)
            since_s, pair = time_s - before_s, Pair(heard.told_sensor[at], -1, -1, 0.0, over_s, heard.reading_m_s[at])
            wanted = at_pulse.at_pulse(held, state, pair.sensor, since_s, over_s, stage, ended)
            again, taken_for = stage_after_pair(held, True, compiled, pair, since_s, stage, ended)
            assert wanted == again == heard.stage[at]
            assert int(state[0]) == heard.believed[at] == taken_for
            assert np.array_equal(state, compiled)
            before_s, stage = time_s, wanted
