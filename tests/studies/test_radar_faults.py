"""Faults of the radar: they are what they are called, and without one the watched loop is the simulator's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models import Plant
from scripts.studies.radar_faults.faults import (
    FROZEN,
    RADAR_FAULTS,
    Biased,
    RadarFault,
    Spikes,
    as_it_is,
    frozen,
    missing,
    standing,
)
from scripts.studies.radar_faults.study import chance, moments_s
from scripts.studies.radar_faults.watched_passes import passes_by_weight, watched_passes
from synth.retarder.estimation.estimator_design import estimator_of
from synth.simulation.closed_loop import ClosedLoop, TableController, close_loop, simulate
from synth.simulation.random_passes import RandomPasses, random_passes
from tests.effort import every
from tests.synth.case_factory import make_plant, make_table
from tuning_tables.programs.decide import HEAVIER_ALARM, LIGHTER_ALARM, LOST_ALARM, SENSOR_ALARM


@pytest.fixture(scope="module")
def passes() -> RandomPasses:
    return random_passes(seed=14, first_pass=0, count=150)


@pytest.fixture(scope="module")
def plant() -> Plant:
    return make_plant(36.0, 4)


@pytest.fixture(scope="module")
def loop(plant: Plant) -> ClosedLoop:
    return close_loop(plant, controllers_of(plant)[0].stages)


def controllers_of(plant: Plant) -> tuple[TableController, TableController]:
    """The same lines for the measured speed, and for the estimated one."""
    table = make_table("test", plant, 3.0)
    return TableController(table), TableController(replace(table, estimator=estimator_of(plant)))


def from_2_s(passes: RandomPasses) -> NDArray[np.float64]:
    return np.full(len(passes), 2.0)


def happening(fault: RadarFault, passes: RandomPasses, plant: Plant) -> RandomPasses:
    return fault.happens_to(passes, plant, from_2_s(passes), chance(1))


# ------------------------------------------------------------------------------------- the watched loop


@pytest.mark.long
@pytest.mark.parametrize("estimator", every(2, [True, False]))
def test_without_fault_it_is_the_simulator_to_the_last_bit(
    plant: Plant, loop: ClosedLoop, passes: RandomPasses, estimator: bool
) -> None:
    controller = controllers_of(plant)[estimator]
    expected = loop.run(controller, loop.draws(passes))
    healthy = happening(RadarFault("none", as_it_is), passes, plant)
    for each in (passes, healthy):
        found = watched_passes(loop, controller, loop.draws(each))
        assert all(np.array_equal(getattr(found.sample, name), value) for name, value in vars(expected).items())
        assert estimator or not found.seen.any()


@pytest.mark.parametrize("estimator", [False, True])
def test_other_faults_are_the_simulators_too(
    plant: Plant, loop: ClosedLoop, passes: RandomPasses, estimator: bool
) -> None:
    controller = controllers_of(plant)[estimator]
    for change in (missing, standing, Biased(0.6)):
        draws = loop.draws(happening(RadarFault("", change, 1.0), passes, plant))
        expected, found = loop.run(controller, draws), watched_passes(loop, controller, draws).sample
        assert np.array_equal(found.exit_speed_m_s, expected.exit_speed_m_s)


@pytest.mark.parametrize("estimator", [False, True])
def test_a_frozen_radar_tells_what_it_told_last(
    plant: Plant, loop: ClosedLoop, passes: RandomPasses, estimator: bool
) -> None:
    """Built another way: pass after pass, sample after sample, with the z that makes the reading out of the speed."""
    controller, sensor, start, end = controllers_of(plant)[estimator], plant.sensor, 25, 45
    stopping, changed = RadarFault("", frozen, (end - start) * sensor.sample_period_s), 0
    for i in range(3):
        one = passes.part(i, i + 1)
        starts_s = (one.phase_u + start - 0.5) * sensor.sample_period_s
        draws = loop.draws(stopping.happens_to(one, plant, starts_s, chance(1)))
        assert np.flatnonzero(draws.noise_z[0] == FROZEN).tolist() == list(range(start, end))
        z = one.noise_z.copy()
        before = speed_m_s(loop, controller, one, start - 1) + sensor.noise_m_s * z[0, start - 1]
        told = np.rint(before / sensor.resolution_m_s) * sensor.resolution_m_s
        for sample in range(start, end):
            now = speed_m_s(loop, controller, replace(one, noise_z=z.copy()), sample)
            z[0, sample] = (told - now) / sensor.noise_m_s
        expected = simulate(plant, controller, replace(one, noise_z=z.copy())).exit_speed_m_s
        assert watched_passes(loop, controller, draws).sample.exit_speed_m_s == pytest.approx(expected, abs=1e-12)
        changed += int(abs(expected[0] - simulate(plant, controller, one).exit_speed_m_s[0]) > 1e-6)
    assert changed > 0  # the fault had something to hide


def speed_m_s(loop: ClosedLoop, controller: TableController, one: RandomPasses, sample: int) -> float:
    """Of the only pass of `one` when it is sampled so often."""
    trace = loop.follow(controller, loop.draws(one))
    time_s = (one.phase_u[0] + sample) * loop.plant.sensor.sample_period_s
    (now,) = np.flatnonzero(np.abs(trace.time_s - time_s) < 1e-9)
    return float(trace.speed_m_s[now])


def test_frozen_before_the_first_reading_is_no_reading(plant: Plant, loop: ClosedLoop, passes: RandomPasses) -> None:
    for controller in controllers_of(plant):
        exits = [
            watched_passes(loop, controller, loop.draws(happening(fault, passes, plant))).sample.exit_speed_m_s
            for fault in (RadarFault("", frozen, from_beginning=True), RadarFault("", missing, from_beginning=True))
        ]
        assert np.array_equal(exits[0], exits[1])


def test_alarms_are_those_of_the_fault(plant: Plant, loop: ClosedLoop, passes: RandomPasses) -> None:
    _, controller = controllers_of(plant)
    blind = watched_passes(loop, controller, loop.draws(happening(RadarFault("", missing), passes, plant)))
    assert ((blind.seen & LOST_ALARM) != 0).mean() > 0.5
    assert ((blind.at_end & LOST_ALARM) != 0).mean() > 0.5
    stuck = watched_passes(loop, controller, loop.draws(happening(RadarFault("", frozen, 1.5), passes, plant)))
    assert ((stuck.seen & SENSOR_ALARM) != 0).all()
    assert ((stuck.at_end & SENSOR_ALARM) != 0).mean() < 0.1
    weak = watched_passes(loop, controller, loop.draws(passes, cut_factor=0.4))
    assert ((weak.at_end & HEAVIER_ALARM) != 0).all()


# ------------------------------------------------------------------------------- a table that takes over


@pytest.mark.long
def test_the_lines_in_force_are_those_of_the_table_that_took_over(
    plant: Plant, loop: ClosedLoop, passes: RandomPasses
) -> None:
    """A pass without alarm is that of its table alone; one that goes over leaves as the other table has it."""
    _, controller = controllers_of(plant)
    estimator = estimator_of(plant)
    hard = tuple(2.5 * each for each in estimator.brake_m2_s2_per_kpa)
    misled = replace(controller.table, estimator=replace(estimator, brake_m2_s2_per_kpa=hard))
    other = TableController(replace(make_table("other", plant, 2.5), estimator=estimator))
    draws = loop.draws(passes, cut_factor=1.0)
    alone = [watched_passes(loop, each, draws).sample.exit_speed_m_s for each in (controller, other)]
    assert (alone[0] != alone[1]).mean() > 0.9
    calm = passes_by_weight(loop, (controller, other), 0, draws)
    assert not (calm.seen & (LIGHTER_ALARM | HEAVIER_ALARM)).any()
    assert np.array_equal(calm.sample.exit_speed_m_s, alone[0])
    found = passes_by_weight(loop, (TableController(misled), other), 0, draws)
    assert (found.table == 1).all()
    from_other, from_own = (np.abs(found.sample.exit_speed_m_s - each) for each in (alone[1], alone[0]))
    assert (from_other < from_own).mean() > 0.9  # the first metres are braked by the own lines


# --------------------------------------------------------------------------------------- the faults


def test_a_fault_lasts_as_long_as_it_should(plant: Plant, passes: RandomPasses) -> None:
    for duration, readings in ((0.3, {2, 3, 4}), (1.0, {9, 10, 11})):
        gone = np.isnan(happening(RadarFault("", missing, duration), passes, plant).noise_z)
        assert set(gone.sum(axis=1).tolist()) <= readings
    gone = np.isnan(happening(RadarFault("", missing), passes, plant).noise_z)
    time_s = (passes.phase_u[:, None] + np.arange(gone.shape[1])) * plant.sensor.sample_period_s
    assert np.array_equal(gone, time_s >= 2.0)
    assert time_s[:, -1].min() > 299.0


def test_readings_before_and_after_a_fault_are_as_they_were(plant: Plant, passes: RandomPasses) -> None:
    healthy = happening(RadarFault("", as_it_is), passes, plant).noise_z
    assert np.array_equal(healthy[:, :256], passes.noise_z)
    for change in (missing, frozen, standing, Biased(-0.6)):
        found = happening(RadarFault("", change, 1.0), passes, plant).noise_z
        assert 9 <= (found != healthy).sum(axis=1).min() <= (found != healthy).sum(axis=1).max() <= 11


def test_spikes_are_as_many_and_as_high_as_asked_for(plant: Plant, passes: RandomPasses) -> None:
    healthy = happening(RadarFault("", as_it_is), passes, plant).noise_z
    faulty = happening(RadarFault("", Spikes(0.05, 3.0), from_beginning=True), passes, plant).noise_z
    off_m_s = plant.sensor.noise_m_s * (faulty - healthy)
    share = (off_m_s != 0.0).mean()
    assert share == pytest.approx(0.05, abs=5.0 * np.sqrt(0.05 / off_m_s.size))
    assert np.abs(off_m_s).max() == pytest.approx(3.0, abs=0.01)
    assert np.std(off_m_s[off_m_s != 0.0]) == pytest.approx(3.0 / np.sqrt(3.0), rel=0.02)


def test_faults_need_a_noisy_sensor(plant: Plant, passes: RandomPasses) -> None:
    silent = replace(plant, sensor=replace(plant.sensor, noise_m_s=0.0))
    with pytest.raises(ValueError, match="no noise"):
        happening(RADAR_FAULTS[1], passes, silent)


def test_moments_lie_evenly_in_the_pass() -> None:
    transit = np.full(4000, 10.0)
    moments = moments_s(transit, 3)
    assert moments.min() >= 0.0
    assert moments.max() < 10.0
    assert moments.mean() == pytest.approx(5.0, abs=5.0 * 10.0 / np.sqrt(12.0 * 4000))
    assert np.array_equal(moments[:50], moments_s(transit[:50], 3))
