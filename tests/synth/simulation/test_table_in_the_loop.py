"""A table for point sensors in the loop: hearing every axle it commands what it commands when told its passages."""

from __future__ import annotations

import numpy as np
import pytest

from plant_models import PointSensors, every_axle, first_axle
from plant_models.point_sensors import Axles
from synth.kernels.loop.passage_pulses import Pair
from synth.kernels.loop.passage_regulator import begin_cut, stage_after_pair
from synth.problem.aim import Aim
from synth.problem.criterion import Criterion
from synth.problem.resolution import Resolution
from synth.retarder.sensors.passage_table import passage_table
from synth.retarder.sensors.tuned_passages import passage_chains, tuned_passages
from synth.simulation.passage_controller import of_table
from synth.simulation.passage_loop import PassageLoop, close_passage_loop
from synth.simulation.passage_sample import UNFINISHED
from synth.simulation.random_passes import random_passes
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.chain.sensor_passages import with_point_sensors
from tests.synth.conftest import pilot_plant
from tuning_tables import Generator
from tuning_tables.passages.held_passages import held_by
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.programs import at_pulse, tracker

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
