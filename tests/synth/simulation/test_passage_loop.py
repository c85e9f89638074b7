"""The loop of passages: readings, common random numbers, any rule and any sensors."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from plant_models import Plant, PointSensors, every_axle, first_axle
from plant_models.point_sensors import deciding_passages
from synth.simulation.closed_loop import close_loop
from synth.simulation.passage_controller import DECIDED, NOT_HEARD, UNFINISHED, PassageSample, of_speeds
from synth.simulation.passage_loop import close_passage_loop, simulate_passages
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.simulation.stratified_passes import stratified_passes
from tests.effort import sized
from tests.synth.conftest import pilot_plant
from tests.synth.simulation.passage_cases import (
    SENSORS,
    braking_rule,
    exact,
    followed,
    holding_rule,
    with_approach,
)


@pytest.fixture(scope="module")
def passes() -> RandomPasses:
    return random_passes(seed=3, first_pass=0, count=1000)


@pytest.fixture(scope="module")
def plant() -> Plant:
    return with_approach(pilot_plant(52.0), 5.0)


def in_stds(sensors: PointSensors, speed_m_s: NDArray[np.float64]) -> NDArray[np.float64]:
    """∫ dv/σ(v) from infinity: in it every reading has std 1."""
    time_in_stds = sensors.base_m / (speed_m_s * sensors.timing_std_s)
    return -np.arcsinh(sensors.base_tolerance * time_in_stds) / sensors.base_tolerance


def test_readings_have_the_noise_of_the_sensors(plant: Plant) -> None:
    """In standard readings the errors have std 1, and the axles of a cut share that of the base."""
    sensors = replace(SENSORS, base_tolerance=0.01, timer_noise_s=2e-4, timer_resolution_s=1e-4, axles=every_axle)
    loop, exact_loop = (close_passage_loop(plant, each, 5) for each in (sensors, exact(sensors)))
    drawn = random_passes(seed=5, first_pass=0, count=1200)
    rule = holding_rule(plant, sensors)
    read = np.array([each.readings.reading_m_s for each in followed(loop, rule, drawn)])
    true = np.array([each.readings.reading_m_s for each in followed(exact_loop, rule, drawn)])
    error = in_stds(sensors, read) - in_stds(sensors, true)
    assert np.abs(error.mean(axis=0)).max() < 4.5 / math.sqrt(len(error))
    assert error.std(axis=0) == pytest.approx(1.0, abs=0.11)
    assert error.std() == pytest.approx(1.0, abs=0.02)
    met = deciding_passages(sensors, plant.cut, plant.exit_m)
    together = np.corrcoef(error.T)
    base = 0.01 * true.mean(axis=0) / sensors.reading_std_m_s(true.mean(axis=0))
    same = np.array([[a.sensor == b.sensor for b in met] for a in met])
    shared = np.where(same, np.outer(base, base), 0.0)
    off = ~np.eye(len(met), dtype=bool)
    assert shared[off & same].min() > 0.3
    assert np.abs(together - shared)[off].max() < 0.14


def test_a_reading_that_is_missing_commands_nothing(plant: Plant, passes: RandomPasses) -> None:
    noise = passes.noise_z.copy()
    noise[:, 3:224] = np.nan
    loop, rule = close_passage_loop(plant, SENSORS, 5), braking_rule(plant, SENSORS, 3.0)
    sample = loop.run(rule, loop.draws(replace(passes, noise_z=noise)))
    assert np.all(sample.outcome[:, 3:] == NOT_HEARD)
    last = np.where(np.arange(6) < 3, 0.0, np.inf)[:, None, None]
    silent = np.where(np.isinf(last), holding_rule(plant, SENSORS).rule.switching_m_s, rule.rule.switching_m_s)
    assert np.array_equal(
        sample.exit_speed_m_s, loop.run(of_speeds(plant, SENSORS, silent), loop.draws(passes)).exit_speed_m_s
    )


def test_before_the_entrance_no_higher_stage_is_entered(passes: RandomPasses) -> None:
    plant = with_approach(pilot_plant(52.0), 5.0, entrance_stage=2, initial_stage=1)
    always = of_speeds(plant, SENSORS, np.zeros((6, 5, 4)))
    for trace in followed(close_passage_loop(plant, SENSORS, 5), always, passes.part(0, 3)):
        assert trace.stage[0] == 1
        assert list(trace.readings.stage[:2]) == [2, 4]


def test_cuts_are_those_of_the_radar(plant: Plant, passes: RandomPasses) -> None:
    radar, points = close_loop(plant, 5), close_passage_loop(plant, SENSORS, 5)
    one, other = radar.draws(passes), points.draws(passes)
    for name in one._fields:
        assert getattr(one, name).tobytes() == getattr(other, name).tobytes()
    for name in radar.path._fields:
        assert np.array_equal(getattr(radar.path, name), getattr(points.radar.path, name))


def test_threads_and_chunks_do_not_change_a_byte(plant: Plant) -> None:
    rule = braking_rule(plant, SENSORS, 3.0)
    whole = simulate_passages(plant, SENSORS, rule, seed=1, count=5300)
    threaded = simulate_passages(plant, SENSORS, rule, seed=1, count=5300, threads=2)
    later = simulate_passages(plant, SENSORS, rule, seed=1, count=3200, first_pass=2100)
    loop = close_passage_loop(plant, SENSORS, 5)
    direct = loop.run(rule, loop.draws(stratified_passes(1, 0, 5300)))
    for name, array in vars(whole).items():
        assert array.tobytes() == getattr(threaded, name).tobytes()
        assert array.tobytes() == getattr(direct, name).tobytes()
        assert array[2100:].tobytes() == getattr(later, name).tobytes()
    assert whole.outcome.shape == (5300, 6)


def test_a_trace_is_the_simulated_pass(plant: Plant, passes: RandomPasses) -> None:
    loop, rule = close_passage_loop(plant, SENSORS, 5), braking_rule(plant, SENSORS, 3.0)
    sample = loop.run(rule, loop.draws(passes))
    for i, trace in enumerate(followed(loop, rule, passes.part(0, 20))):
        assert trace.exit_speed_m_s == sample.exit_speed_m_s[i]
        assert trace.time_s[-1] == sample.transit_time_s[i]
        assert np.count_nonzero(np.diff(trace.stage)) == sample.switchings[i]
        assert np.all(np.diff(trace.time_s) > 0)
        assert trace.path_m[-1] == plant.exit_m
        assert np.count_nonzero(~np.isnan(trace.measured_m_s)) == len(trace.readings.time_s)
    assert sample.switchings.mean() > 1.5


@settings(max_examples=sized(15, 60))
@given(st.data())
def test_any_rule_and_sensors_end_every_pass(data: st.DataObject) -> None:
    plant = with_approach(pilot_plant(data.draw(st.sampled_from([22.0, 52.0, 85.0]))), 4.0)
    gaps = data.draw(st.lists(st.floats(0.31, 8.0), max_size=12))
    sensors = PointSensors(
        tuple(np.cumsum([-4.0, *gaps]).tolist()),
        base_m=data.draw(st.floats(0.05, 0.3)),
        base_tolerance=data.draw(st.floats(0.0, 0.2)),
        timer_noise_s=data.draw(st.floats(0.0, 0.05)),
        timer_resolution_s=data.draw(st.sampled_from([0.0, 1e-4, 0.05])),
        computing_delay_s=data.draw(st.floats(0.0, 2.0)),
        scan_period_s=data.draw(st.floats(0.005, 0.5)),
        axles=data.draw(st.sampled_from([first_axle, every_axle])),
    )
    top = plant.top_stage
    count = len(deciding_passages(sensors, plant.cut, plant.exit_m))
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32)))
    speeds = np.sort(rng.uniform(0.0, 7.0, (count, top + 1, top)), axis=2)
    speeds[rng.random(speeds.shape) < 0.1] = np.inf
    sample = simulate_passages(plant, sensors, of_speeds(plant, sensors, np.sort(speeds, axis=2)), 11, 60)
    require_sound(sample, top)


def require_sound(sample: PassageSample, top: int) -> None:
    """Every pass ends, and what it leaves can be."""
    assert np.all(np.isfinite(sample.exit_speed_m_s) & (sample.exit_speed_m_s >= 0.0))
    assert np.all((sample.exit_speed_m_s == 0.0) == sample.stalled)
    assert np.all((sample.transit_time_s > 1.0) & (sample.transit_time_s <= 300.0))
    assert np.all(sample.switchings <= (sample.outcome == DECIDED).sum(axis=1))
    assert sample.outcome.max(initial=0) <= UNFINISHED


def test_what_does_not_fit_is_refused(plant: Plant) -> None:
    loop = close_passage_loop(plant, SENSORS, 5)
    draws = loop.draws(random_passes(1, 0, 2))
    with pytest.raises(ValueError, match="3 stages, the loop 5"):
        loop.run(braking_rule(with_approach(pilot_plant(22.0), 5.0), SENSORS, 2.0), draws)
    with pytest.raises(ValueError, match="not those of sensors and cut"):
        loop.run(braking_rule(plant, replace(SENSORS, path_m=(-5.0, 4.0)), 3.0), draws)
    with pytest.raises(ValueError, match="first sensor stands at -5 m and the plant begins at 0 m"):
        close_passage_loop(pilot_plant(52.0), SENSORS, 5)
    with pytest.raises(ValueError, match="no axle at which is decided passes"):
        close_passage_loop(plant, PointSensors((80.0,)), 5)
    with pytest.raises(ValueError, match="has shape"):
        of_speeds(plant, SENSORS, np.zeros((6, 4, 4)))
    with pytest.raises(ValueError, match="must not fall"):
        of_speeds(plant, SENSORS, np.tile([4.0, 3.0, 5.0, 6.0], (6, 5, 1)))
    with pytest.raises(ValueError, match="six numbers"):
        braking_rule(plant, SENSORS, 3.0, limits=(1.0, 2.0))
