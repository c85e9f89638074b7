"""Readings of passes: in a log, and lost.

Simulated passes as a log: the rows are what the regulator saw and did, the gauge follows the drive.
Lost readings: share, bursts and correlation against the closed forms of the chain, and nothing else moved.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models import Approach, DopplerSensor, Plant, PlantError
from plant_models.pressure_regulator import PressureGauge
from synth.kernels.loop.passes import Draws
from synth.retarder.comparison.baselines import energy_rule
from synth.retarder.configuration.config_file import parse_config
from synth.simulation.closed_loop import LineController, close_loop, simulate, trace
from synth.simulation.common_passes import common_passes
from synth.simulation.nominal_response import nominal_plant
from synth.simulation.random_passes import RandomPasses, keyed_passes, lost_readings, random_passes, readings_z
from synth.simulation.sampled_pass import GAP_S, LoggedClass, logged_passes, mixed_log
from synth.simulation.stratified_passes import stratified_passes
from tests.synth.case_factory import make_case
from tuning_tables.pass_log.pass_log import PassLog

TARGET_M_S = 2.0
EXACT_GAUGE = PressureGauge(0.0, 0.0)


def regulator(plant: Plant) -> LineController:
    return energy_rule(close_loop(plant, plant.top_stage + 1), TARGET_M_S, plant.top_stage, 0.8, 0.15, 0.0, 0.15)


def drawn(plant: Plant, controller: LineController, seed: int, count: int) -> RandomPasses:
    loop = close_loop(plant, controller.stages)
    return random_passes(seed, 0, count, len(loop.path.gravity_m_s2) - loop.path.approach_cells)


@pytest.fixture(scope="module", params=[0.0, 6.0], ids=["at the entrance", "approached"])
def plant(request: pytest.FixtureRequest, plant_52t: Plant) -> Plant:
    return replace(plant_52t, approach=Approach(request.param, 1, 0)) if request.param else plant_52t


def test_rows_at_rest_are_what_the_regulator_saw_and_all_rows_lie_on_the_trace(plant: Plant) -> None:
    controller, period = regulator(plant), plant.sensor.sample_period_s
    log, passes = logged_passes(plant, controller, TARGET_M_S, 3, 0, 20, None), drawn(plant, controller, 3, 20)
    for number in range(20):
        events, rows = trace(plant, controller, passes, number), log.rows(number)
        first_s = float(passes.phase_u[number]) * period
        since = first_s + log.time_s[rows] - log.time_s[rows.start]
        event = np.abs(since[:, None] - events.time_s[1:-1]).argmin(axis=1) + 1
        assert np.allclose(events.time_s[event], since, atol=1e-6)
        assert np.array_equal(events.path_m[event], log.path_m[rows])
        assert np.array_equal(events.stage[event], log.stage[rows])
        looked = np.isfinite(events.measured_m_s)
        assert np.array_equal(np.flatnonzero(looked), event[np.isfinite(events.measured_m_s[event])])
        assert np.array_equal(events.measured_m_s[looked], log.speed_m_s[rows][looked[event]])
        assert len(since) == int((events.time_s[-1] - first_s) / period) + 1  # every sample, also in a transient


def test_speeds_are_measured_while_the_pressure_changes(plant_52t: Plant) -> None:
    sensor = replace(plant_52t.sensor, noise_m_s=0.03, resolution_m_s=0.01)
    plant = replace(plant_52t, sensor=sensor)
    controller = regulator(plant)
    log, passes = logged_passes(plant, controller, TARGET_M_S, 4, 0, 300, None), drawn(plant, controller, 4, 300)
    errors = []
    for number in range(300):
        events, rows = trace(plant, controller, passes, number), log.rows(number)
        since = passes.phase_u[number] * sensor.sample_period_s + log.time_s[rows] - log.time_s[rows.start]
        errors.append(log.speed_m_s[rows] - np.interp(since, events.time_s, events.speed_m_s))
    error = np.concatenate(errors)
    assert abs(error.mean()) < 5 * sensor.reading_std_m_s / np.sqrt(len(error))
    assert error.std() == pytest.approx(sensor.reading_std_m_s, rel=0.02)
    assert np.allclose(log.speed_m_s, np.round(log.speed_m_s, 2), atol=1e-9)


def test_the_gauge_agrees_with_the_overpressure_that_braked(plant: Plant) -> None:
    """At rest both are equal; in a transient the simulator brakes with means over 20 ms, which lag by that at most."""
    controller, period = regulator(plant), plant.sensor.sample_period_s
    log, passes = logged_passes(plant, controller, TARGET_M_S, 5, 0, 10, EXACT_GAUGE), drawn(plant, controller, 5, 10)
    drive, touch = plant.position.pneumatics, plant.position.force.touch_pressure_kpa
    steepest_kpa_s = drive.supply_pressure_kpa / min(drive.fill_time_constant_s, drive.exhaust_time_constant_s)
    compared = 0
    for number in range(10):
        events, rows = trace(plant, controller, passes, number), log.rows(number)
        since = passes.phase_u[number] * period + log.time_s[rows] - log.time_s[rows.start]
        event = np.abs(since[:, None] - events.time_s[1:-1]).argmin(axis=1) + 1
        apart = np.abs(np.maximum(0.0, log.pressure_kpa[rows] - touch) - events.overpressure_kpa[event])
        resting = np.isfinite(events.measured_m_s[event]) & (events.stage[event] == events.stage[event - 1])
        assert np.all(apart[resting] < 1e-6)
        assert np.all(apart <= 0.02 * steepest_kpa_s)
        compared += int((~resting).sum())
    assert compared > 30


def test_the_gauge_follows_the_closed_form_of_one_command(plant_52t: Plant) -> None:
    """First command of each pass, from release: dead times, then an exponential up to the edge of the band."""
    log = logged_passes(plant_52t, regulator(plant_52t), TARGET_M_S, 6, 0, 30, EXACT_GAUGE)
    drive, delay_s = plant_52t.position.pneumatics, plant_52t.sensor.computing_delay_s
    dead_s = delay_s + drive.brake_delay_s + drive.touch_delay_s
    for number in range(len(log)):
        rows = log.rows(number)
        stage, time, pressure = log.stage[rows], log.time_s[rows], log.pressure_kpa[rows]
        at = int(np.argmax(stage > 0))
        assert pressure[0] == drive.dead_band_kpa  # stage 0 is reached from above
        edge = plant_52t.position.stage_pressures_kpa[stage[at]] - drive.dead_band_kpa
        open_s = np.maximum(0.0, time - time[at] - dead_s)
        lack = (drive.supply_pressure_kpa - pressure[0]) * np.exp(-open_s / drive.fill_time_constant_s)
        wanted = np.minimum(edge, drive.supply_pressure_kpa - lack)
        end = at + int(np.argmax(stage[at:] != stage[at])) if (stage[at:] != stage[at]).any() else len(stage)
        assert np.allclose(pressure[:end], wanted[:end], atol=1e-6)


def test_gauge_noise_and_resolution_are_as_given(plant_52t: Plant) -> None:
    controller = regulator(plant_52t)
    true, shown = (
        logged_passes(plant_52t, controller, TARGET_M_S, 7, 0, 100, gauge).pressure_kpa
        for gauge in (EXACT_GAUGE, PressureGauge(3.0, 0.5))
    )
    error = shown - true
    assert error.std() == pytest.approx(np.hypot(3.0, 0.5 / np.sqrt(12.0)), rel=0.03)
    assert abs(error.mean()) < 5 * 3.0 / np.sqrt(len(error))
    assert np.array_equal(shown, np.rint(shown / 0.5) * 0.5)
    assert not logged_passes(plant_52t, controller, TARGET_M_S, 7, 0, 2, None).has_gauge
    with pytest.raises(PlantError, match="gauge: noise_kpa"):
        PressureGauge(-1.0)


def test_a_pass_does_not_depend_on_how_many_are_logged(plant_52t: Plant) -> None:
    controller, gauge = regulator(plant_52t), PressureGauge(2.0)
    many = logged_passes(plant_52t, controller, TARGET_M_S, 8, 0, 12, gauge)
    few = logged_passes(plant_52t, controller, TARGET_M_S, 8, 5, 3, gauge)
    part = many.taken([5, 6, 7])
    assert few.cut_id == part.cut_id == ("cut-000005", "cut-000006", "cut-000007")
    for name in ("path_m", "speed_m_s", "pressure_kpa", "stage", "first_row"):
        assert np.array_equal(getattr(few, name), getattr(part, name))
    assert len(simulate(plant_52t, controller, drawn(plant_52t, controller, 8, 12))) == len(many)


def gaps_s(log: PassLog) -> np.ndarray:
    return log.time_s[log.first_row[1:-1]] - log.time_s[log.first_row[1:-1] - 1]


def test_a_mixed_log_holds_the_passes_of_every_class_in_one_shuffled_row(plant_22t: Plant, plant_52t: Plant) -> None:
    classes = [LoggedClass(plant, regulator(plant), TARGET_M_S) for plant in (plant_22t, plant_52t)]
    log = mixed_log(classes, [6, 10], 9, PressureGauge(2.0))
    assert np.count_nonzero(log.mass_t == 22.0) == 6
    assert np.count_nonzero(log.mass_t == 52.0) == 10
    assert len(set(np.flatnonzero(log.mass_t == 22.0)) - set(range(6))) > 0
    assert log.cut_id == tuple(f"cut-{number:06d}" for number in range(16))
    assert np.all(np.diff(log.time_s) > 0.0)
    assert np.allclose(gaps_s(log), GAP_S, atol=2e-3)
    again = mixed_log(classes, [6, 10], 9, PressureGauge(2.0))
    assert np.array_equal(log.speed_m_s, again.speed_m_s)
    entry = [log.speed_m_s[log.first_row[:-1]][log.mass_t == mass][:6] for mass in (22.0, 52.0)]
    assert not np.array_equal(*entry)  # not the same numbers for both classes


def test_no_passes_are_refused(plant_52t: Plant) -> None:
    with pytest.raises(ValueError, match="0 passes"):
        logged_passes(plant_52t, regulator(plant_52t), TARGET_M_S, 1, 0, 0, None)


LAWS = [(1.0 / 3.0, 0.6, 0.1), (0.05, 0.1, 0.1), (0.5, 0.2, 0.1), (0.2, 3.0, 0.05), (0.3, 5.0, 0.02)]
"""Share, mean burst in s, sampling period in s."""
SIGMAS = 4.5


@pytest.fixture(scope="module")
def row() -> RandomPasses:
    return random_passes(11, 0, 4000, 1)


def losing(share: float, burst_s: float, period_s: float = 0.1) -> DopplerSensor:
    return DopplerSensor(0.05, 0.04, period_s, 0.02, share, burst_s)


def bytes_of(draws: Draws) -> list[bytes]:
    return [np.asarray(array).tobytes() for array in draws]


def near(values: NDArray[np.float64], expected: float) -> None:
    """The mean of `values`, one a pass, is `expected` within its own standard error."""
    allowed = SIGMAS * values.std() / np.sqrt(values.size) + 1e-12
    assert abs(values.mean() - expected) < allowed, (values.mean(), expected, allowed)


@pytest.mark.parametrize(("share", "burst_s", "period_s"), LAWS)
def test_share_bursts_and_correlation_are_those_of_the_chain(
    row: RandomPasses, share: float, burst_s: float, period_s: float
) -> None:
    lost = np.isnan(readings_z(row, losing(share, burst_s, period_s)))
    mean = burst_s / period_s
    assert lost.shape[1] % 256 == 0
    assert lost.shape[1] >= 8 * mean
    near(lost.mean(axis=1), share)
    # On the ring: what comes after the last reading is the first, for the numbers of the sensor come again.
    after = np.roll(lost, -1, axis=1)
    ends = lost & ~after
    near(lost.mean(axis=1) - mean * ends.mean(axis=1), 0.0)  # mean burst = readings lost / bursts
    long = lost & after & np.roll(lost, -2, axis=1)
    near(long.mean(axis=1) - share * (1.0 - 1.0 / mean) ** 2, 0.0)  # a burst is of geometric length
    kept = 1.0 - 1.0 / mean - share / (mean * (1.0 - share))
    for here, there in ((100, 101), (-1, 0)):  # the same within the ring and over its seam
        near((lost[:, here] - share) * (lost[:, there] - share) - share * (1.0 - share) * kept, 0.0)


def test_without_losses_the_numbers_are_the_very_same(row: RandomPasses, plant_52t: Plant) -> None:
    assert readings_z(row, losing(0.0, 0.6)) is row.noise_z
    one, other = (
        close_loop(replace(plant_52t, sensor=replace(plant_52t.sensor, missed_burst_s=burst)), 5)
        for burst in (0.6, 2.0)
    )
    few = row.part(0, 50)
    for a, b in zip(bytes_of(one.draws(few)), bytes_of(other.draws(few)), strict=True):
        assert a == b


def test_keys_move_no_other_number(row: RandomPasses) -> None:
    """The numbers of a block, drawn again in the order that defined them before there were keys."""
    rng = np.random.Generator(np.random.SFC64(np.random.SeedSequence(11, spawn_key=(0,))))
    assert rng.standard_normal(1000).tobytes() == row.cut_z[:1000].tobytes()
    for drawn in (row.entry_u, row.phase_u, row.resistance_u):
        assert rng.random(1000).tobytes() == drawn[:1000].tobytes()
    assert np.unique(row.loss_key).size == len(row)
    assert row.loss_key.min() >= 0


def test_what_is_heard_is_not_moved(row: RandomPasses) -> None:
    heard = readings_z(row, losing(0.3, 0.5))
    there = ~np.isnan(heard)
    assert np.array_equal(heard[there], row.noise_z[there])


def test_a_pass_loses_the_same_readings_wherever_it_stands(row: RandomPasses) -> None:
    sensor, whole = losing(0.3, 0.5), lost_readings(row.loss_key, losing(0.3, 0.5), 256)
    assert np.array_equal(lost_readings(random_passes(11, 990, 20, 1).loss_key, sensor, 256), whole[990:1010])
    assert np.array_equal(lost_readings(stratified_passes(11, 0, 100, 1).loss_key, sensor, 256), whole[:100])
    key = np.arange(30)
    by_key = keyed_passes(3, (key,), (key,), 1).loss_key
    assert np.array_equal(by_key[10:], keyed_passes(3, (key[10:],), (key[10:],), 1).loss_key)
    assert np.unique(by_key).size == 30


def test_the_nominal_pass_hears_everything(plant_52t: Plant) -> None:
    assert nominal_plant(replace(plant_52t, sensor=losing(0.4, 0.6))).sensor.missed_share == 0.0


def test_brake_power_is_that_of_a_regulator_that_hears(plant_52t: Plant, row: RandomPasses) -> None:
    few = random_passes(11, 0, 300)
    lossy = replace(plant_52t, sensor=replace(plant_52t.sensor, missed_share=0.4))
    one, other = (common_passes(plant, few).at_full_brake for plant in (plant_52t, lossy))
    assert one.exit_speed_m_s.tobytes() == other.exit_speed_m_s.tobytes()


def test_a_burst_is_one_reading_at_least() -> None:
    with pytest.raises(PlantError, match=r"sensor: missed_burst_s is 0\.1; it must be from 0\.2, one reading"):
        losing(0.1, 0.1, 0.2)
    losing(0.0, 0.1, 0.2)  # nothing is lost, so nothing lasts too short


def test_a_configuration_reaches_the_plant() -> None:
    config = parse_config("[sensor]\nmissed_share = 0.2\nmissed_burst_s = 0.5\n", "x.toml")
    sensor = config.plants()[0][1].sensor
    assert (sensor.missed_share, sensor.missed_burst_s) == (0.2, 0.5)


def test_an_exact_prediction_says_that_it_counts_on_every_reading() -> None:
    case = make_case()
    assert not case.warnings
    lossy = replace(case.plant, sensor=replace(case.plant.sensor, missed_share=0.2))
    [warning] = replace(case, plant=lossy).warnings
    assert warning.startswith("the prediction of the table counts on every reading, but 20 % are lost")
