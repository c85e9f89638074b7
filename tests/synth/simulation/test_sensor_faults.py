"""Faults of point sensors: each does what it says, none breaks the loop, and what is not believed commands nothing."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plant_models import Plant, PointSensors, every_axle, first_axle
from plant_models.point_sensors import Axles
from scripts.studies.point_sensors.sensor_faults import (
    DeadSensor,
    LateSensor,
    LoneAxle,
    MissedPulses,
    RepeatedPulses,
    ReversedSensor,
    SensorFault,
    SpuriousPulses,
    StuckReading,
    SwappedSensors,
    together,
)
from synth.simulation.passage_controller import DECIDED, NOT_BELIEVED, NOT_HEARD, PassReadings, of_speeds
from synth.simulation.passage_loop import PassageLoop, close_passage_loop
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.simulation.stratified_passes import stratified_passes
from tests.effort import sized
from tests.synth.conftest import pilot_plant
from tests.synth.simulation.passage_cases import SENSORS, braking_rule, holding_rule, limits_of, with_approach


@pytest.fixture(scope="module")
def plant() -> Plant:
    return with_approach(pilot_plant(52.0), 5.0)


@pytest.fixture(scope="module")
def passes() -> RandomPasses:
    return random_passes(seed=8, first_pass=0, count=400)


@pytest.fixture(scope="module")
def loop(plant: Plant) -> PassageLoop:
    return close_passage_loop(plant, SENSORS, 5)


def heard(loop: PassageLoop, passes: RandomPasses, at: int, *faults: SensorFault) -> PassReadings:
    """What a regulator that never commands hears of pass `at`."""
    limits = limits_of(loop.plant, loop.sensors)
    controller = holding_rule(loop.plant, loop.sensors, limits)
    draws = loop.draws(passes.part(at, at + 1))
    return loop.follow(controller, draws, together(loop.sensors, faults)).readings


# -------------------------------------------------------------------------------------------- no fault


A_WHEELBASE_APART = PointSensors((-5.0, 3.65, 12.3, 20.95, 30.0), base_tolerance=0.015)


@pytest.mark.parametrize(
    ("mass_t", "axles", "sensors"),
    [*itertools.product([22.0, 52.0, 85.0], [first_axle, every_axle], [SENSORS, A_WHEELBASE_APART])],
)
def test_without_a_fault_the_tracker_believes_the_truth(mass_t: float, axles: Axles, sensors: PointSensors) -> None:
    plant, sensors = with_approach(pilot_plant(mass_t), 5.0), replace(sensors, axles=axles)
    loop = close_passage_loop(plant, sensors, plant.top_stage + 1)
    draws = loop.draws(stratified_passes(2, 0, 2000))
    told = loop.run(braking_rule(plant, sensors, 2.0), draws)
    tracked = loop.run(braking_rule(plant, sensors, 2.0, limits_of(plant, sensors)), draws)
    assert not np.any(tracked.outcome == NOT_BELIEVED)
    np.testing.assert_allclose(tracked.exit_speed_m_s, told.exit_speed_m_s, rtol=1e-9)
    assert np.array_equal(tracked.switchings, told.switchings)
    assert tracked.outcome.tobytes() == told.outcome.tobytes()


@settings(max_examples=sized(10, 40))
@given(st.data())
def test_wherever_sensors_stand_the_tracker_believes_the_truth(data: st.DataObject) -> None:
    plant = with_approach(pilot_plant(data.draw(st.sampled_from([22.0, 52.0, 85.0]))), 3.0)
    gaps = data.draw(st.lists(st.floats(0.5, 12.0), max_size=8))
    sensors = PointSensors(tuple(np.cumsum([-3.0, *gaps]).tolist()), base_tolerance=data.draw(st.floats(0.0, 0.02)))
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32)))
    loop, top = close_passage_loop(plant, sensors, plant.top_stage + 1), plant.top_stage
    speeds = np.sort(rng.uniform(2.0, 7.0, (len(loop.deciding.path_m), top + 1, top)), axis=2)
    tracking = of_speeds(plant, sensors, speeds, limits_of(plant, sensors))
    sample = loop.run(tracking, loop.draws(stratified_passes(9, 0, 200)))
    # Beyond 4 standard deviations, or slower than is believed, a pair may be lost; a wrong one is never believed.
    assert np.count_nonzero(sample.outcome == NOT_BELIEVED) <= 2 + 0.05 * np.count_nonzero(sample.stalled)


# ------------------------------------------------------------------------------- each does what it says


def test_a_dead_sensor_is_as_one_that_never_commands(plant: Plant, loop: PassageLoop, passes: RandomPasses) -> None:
    limits, draws = limits_of(plant, SENSORS), loop.draws(passes)
    rule = braking_rule(plant, SENSORS, 3.0, limits)
    for sensor in range(6):
        speeds = rule.rule.switching_m_s.copy()
        speeds[sensor] = holding_rule(plant, SENSORS).rule.switching_m_s[sensor]
        sample = loop.run(rule, draws, together(SENSORS, [DeadSensor(sensor)]))
        silent = loop.run(of_speeds(plant, SENSORS, speeds), draws)
        np.testing.assert_allclose(sample.exit_speed_m_s, silent.exit_speed_m_s, rtol=1e-9)
        assert np.array_equal(sample.switchings, silent.switchings)
        assert np.all(sample.outcome[:, sensor] == NOT_HEARD)


def test_stuck_reversed_late_and_swapped_sensors_tell_what_they_should(loop: PassageLoop, passes: RandomPasses) -> None:
    over = loop.heard.sensor
    for at in (0, 7):
        true = heard(loop, passes, at)
        assert list(true.told_sensor) == list(over)
        assert list(true.believed) == list(true.passage) == list(range(len(over)))
        dead = heard(loop, passes, at, DeadSensor(2))
        assert list(dead.passage) == list(dead.believed) == list(np.flatnonzero(over != 2))
        stuck = heard(loop, passes, at, StuckReading(2, 4.25))
        assert stuck.reading_m_s == pytest.approx(np.where(over == 2, 4.25, true.reading_m_s), rel=1e-15)
        turned = heard(loop, passes, at, ReversedSensor(3))
        assert np.all(turned.reading_m_s[over == 3] < 0.0)
        assert list(turned.believed) == [-1 if sensor == 3 else i for i, sensor in enumerate(over)]
        late = heard(loop, passes, at, LateSensor(1, 0.4))
        assert late.time_s[np.argsort(late.passage)] - true.time_s == pytest.approx(np.where(over == 1, 0.4, 0.0))
        assert late.middle_s[np.argsort(late.passage)] - true.middle_s == pytest.approx(np.where(over == 1, 0.4, 0.0))
        swapped = heard(loop, passes, at, SwappedSensors(4))
        assert list(swapped.told_sensor) == [{4: 5, 5: 4}.get(sensor, sensor) for sensor in over]
        assert list(swapped.passage) == list(range(len(over)))


def test_a_pair_too_many_costs_nothing(plant: Plant, loop: PassageLoop, passes: RandomPasses) -> None:
    true = heard(loop, passes, 0)
    again = heard(loop, passes, 0, RepeatedPulses(1, 2, 0.05))
    for i in np.flatnonzero(loop.heard.sensor == 1):
        same = np.flatnonzero(again.passage == i)
        assert list(again.told_sensor[same]) == [1, 1, 1]
        assert again.time_s[same] - true.time_s[i] == pytest.approx([0.0, 0.05, 0.1])
        assert list(again.reading_m_s[same]) == [true.reading_m_s[i]] * 3
        assert list(again.believed[same]) == [i, -1, -1]
    rest = again.told_sensor != 1
    assert list(again.believed[rest]) == list(again.passage[rest])
    rule, draws = braking_rule(plant, SENSORS, 3.0, limits_of(plant, SENSORS)), loop.draws(passes)
    for fault in (RepeatedPulses(None, 1, 0.05), RepeatedPulses(3, 8, 0.1)):
        doubled = loop.run(rule, draws, together(SENSORS, [fault]))
        alone = loop.run(rule, draws)
        np.testing.assert_allclose(doubled.exit_speed_m_s, alone.exit_speed_m_s, rtol=1e-11)
        assert np.array_equal(doubled.switchings, alone.switchings)


def test_pairs_are_missed_by_chance_and_the_same_for_every_controller(
    plant: Plant, loop: PassageLoop, passes: RandomPasses
) -> None:
    limits, draws = limits_of(plant, SENSORS), loop.draws(passes)
    fault = together(SENSORS, [MissedPulses(0.3)])
    lost = loop.run(holding_rule(plant, SENSORS, limits), draws, fault).outcome == NOT_HEARD
    assert lost.mean(axis=0) == pytest.approx(0.3, abs=4.5 * np.sqrt(0.21 / 400))
    assert np.abs(np.corrcoef(lost.T) - np.eye(6)).max() < 4.5 / np.sqrt(400)
    braked = loop.run(braking_rule(plant, SENSORS, 3.0, limits), draws, fault)
    went = ~braked.stalled  # one that stalls is not heard farther on
    assert np.count_nonzero(went) > 200
    assert np.array_equal(lost[went], braked.outcome[went] == NOT_HEARD)
    other = loop.run(holding_rule(plant, SENSORS, limits), draws, together(SENSORS, [MissedPulses(0.3, stream=5)]))
    assert 0.35 < np.mean((other.outcome == NOT_HEARD) != lost) < 0.49


def test_spurious_pairs_come_in_their_time_and_lone_axles_by_their_speed(
    loop: PassageLoop, passes: RandomPasses
) -> None:
    false = [heard(loop, passes, at, SpuriousPulses(3, 4.0, (1.0, 2.0))) for at in range(60)]
    rows = [np.array([each.time_s, each.told_sensor, each.reading_m_s])[:, each.passage < 0] for each in false]
    assert [row.shape for row in rows] == [(3, 3)] * 60
    time, sensor, speed = np.concatenate(rows, axis=1)
    assert np.all((time >= 0.0) & (time <= 4.0))
    assert time.mean() == pytest.approx(2.0, abs=0.4)
    assert speed.mean() == pytest.approx(1.5, abs=0.1)
    assert np.bincount(sensor.astype(int), minlength=6).min() > 12
    axle = heard(loop, passes, 0, LoneAxle(3.0, 5.0))
    lone = axle.passage < 0
    assert axle.time_s[lone] == pytest.approx((np.array(SENSORS.path_m) + 5.0) / 5.0 - 3.0)
    assert list(axle.told_sensor[lone]) == [0, 1, 2, 3, 4, 5]
    assert np.all(np.diff(axle.time_s) >= 0.0)


def test_a_cut_behind_a_lone_axle_is_believed_from_its_second_axle_on(loop: PassageLoop, passes: RandomPasses) -> None:
    behind = heard(loop, passes, 0, LoneAxle(30.0, 5.0))
    cut = behind.passage >= 0
    assert list(behind.passage[cut]) == list(range(len(loop.heard.sensor)))
    assert list(behind.believed[cut]) == [-1, *range(1, len(loop.heard.sensor))]


# --------------------------------------------------------------------------------------- any sequence


def any_fault(data: st.DataObject, sensors: int, stream: int) -> SensorFault:
    """Some fault of some sensor."""
    sensor = data.draw(st.integers(0, sensors - 1))
    some = data.draw(st.sampled_from([None, sensor]))
    faults: list[SensorFault] = [
        DeadSensor(sensor),
        StuckReading(sensor, data.draw(st.floats(-1.0, 50.0))),
        ReversedSensor(sensor),
        LateSensor(sensor, data.draw(st.floats(0.0, 5.0))),
        RepeatedPulses(some, data.draw(st.integers(1, 9)), data.draw(st.floats(0.001, 2.0))),
        MissedPulses(data.draw(st.floats(0.0, 1.0)), some, stream),
        SpuriousPulses(data.draw(st.integers(1, 6)), data.draw(st.floats(0.1, 60.0)), (0.1, 12.0), stream),
        LoneAxle(data.draw(st.floats(-20.0, 60.0)), data.draw(st.floats(0.1, 12.0))),
    ]
    if sensor + 1 < sensors:
        faults.append(SwappedSensors(sensor))
    return data.draw(st.sampled_from(faults))


@settings(max_examples=sized(25, 100))
@given(st.data())
def test_any_faults_leave_a_sound_loop(data: st.DataObject) -> None:
    plant = with_approach(pilot_plant(data.draw(st.sampled_from([22.0, 52.0]))), 5.0, 2, data.draw(st.integers(0, 2)))
    sensors = replace(SENSORS, axles=data.draw(st.sampled_from([first_axle, every_axle])))
    faults = [any_fault(data, 6, stream) for stream in range(data.draw(st.integers(0, 4)))]
    loop, top = close_passage_loop(plant, sensors, plant.top_stage + 1), plant.top_stage
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32)))
    speeds = np.sort(rng.uniform(0.0, 8.0, (len(loop.deciding.path_m), top + 1, top)), axis=2)
    rule = of_speeds(plant, sensors, speeds, limits_of(plant, sensors))
    drawn = stratified_passes(12, data.draw(st.integers(0, 999)), 40)
    sample = loop.run(rule, loop.draws(drawn), together(sensors, faults))
    assert np.all(np.isfinite(sample.exit_speed_m_s) & (sample.exit_speed_m_s >= 0.0))
    assert np.all((sample.exit_speed_m_s == 0.0) == sample.stalled)
    assert np.all(np.isfinite(sample.transit_time_s) & (sample.transit_time_s <= 300.0))
    trace = loop.follow(rule, loop.draws(drawn.part(0, 1)), together(sensors, faults))
    told = trace.readings
    assert trace.exit_speed_m_s == sample.exit_speed_m_s[0]
    assert np.all((trace.stage >= 0) & (trace.stage <= top))
    assert np.all((told.believed >= -1) & (told.believed < len(rule.rule.path_m)))
    assert np.all((told.outcome == NOT_BELIEVED) == (told.believed < 0))
    steps = np.diff(told.stage, prepend=plant.approach.initial_stage)
    changed = steps != 0
    assert np.all(told.outcome[changed] == DECIDED)
    assert np.count_nonzero(changed) == sample.switchings[0]
    early = (steps > 0) & (rule.rule.path_m[told.believed] < 0.0)
    assert np.all(told.stage[early] <= 2)


# --------------------------------------------------------------------------------------------- figures
