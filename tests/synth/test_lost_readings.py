"""Lost readings: share, bursts and correlation against the closed forms of the chain, and nothing else moved."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models import DopplerSensor, Plant, PlantError
from synth.frame.input_error import InputError
from synth.kernels.loop.passes import Draws
from synth.retarder.configuration.config_file import parse_config
from synth.simulation.closed_loop import close_loop
from synth.simulation.common_passes import common_passes
from synth.simulation.keyed_passes import keyed_passes
from synth.simulation.lost_readings import lost_readings, readings_z
from synth.simulation.nominal_pass import nominal_plant
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.simulation.stratified_passes import stratified_passes
from tests.synth.case_factory import make_case

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


def test_the_first_reading_is_lost_as_any(row: RandomPasses) -> None:
    lost = np.isnan(readings_z(row, losing(0.25, 1.0)))
    for sample in (0, 1, 255):
        near(lost[:, sample].astype(float), 0.25)


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


def test_more_is_lost_where_more_is_to_be_lost(row: RandomPasses) -> None:
    """Common numbers: whatever is lost at a small share is lost at a larger one, too."""
    few, more = (lost_readings(row.loss_key[:500], losing(share, 0.6), 256) for share in (0.1, 0.3))
    assert not np.any(few & ~more)


def test_the_nominal_pass_hears_everything(plant_52t: Plant) -> None:
    assert nominal_plant(replace(plant_52t, sensor=losing(0.4, 0.6))).sensor.missed_share == 0.0


def test_brake_power_is_that_of_a_regulator_that_hears(plant_52t: Plant, row: RandomPasses) -> None:
    few = random_passes(11, 0, 300)
    lossy = replace(plant_52t, sensor=replace(plant_52t.sensor, missed_share=0.4))
    one, other = (common_passes(plant, few).at_full_brake for plant in (plant_52t, lossy))
    assert one.exit_speed_m_s.tobytes() == other.exit_speed_m_s.tobytes()


@pytest.mark.parametrize("share", [-0.1, 0.51, float("nan")])
def test_no_other_share(share: float) -> None:
    with pytest.raises(PlantError, match="sensor: missed_share is"):
        losing(share, 0.6)


def test_a_burst_is_one_reading_at_least() -> None:
    with pytest.raises(PlantError, match=r"sensor: missed_burst_s is 0\.1; it must be from 0\.2, one reading"):
        losing(0.1, 0.1, 0.2)
    losing(0.0, 0.1, 0.2)  # nothing is lost, so nothing lasts too short


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("missed_share = 0.6", "sensor.missed_share is 0.6; it must be a finite number from 0 to 0.5"),
        ("missed_share = 0.2\nmissed_burst_s = 0.05", "sensor.missed_burst_s is 0.05; it must be from 0.1"),
    ],
)
def test_a_configuration_is_told_by_its_keys(text: str, told: str) -> None:
    with pytest.raises(InputError, match=told.replace(".", r"\.")):
        parse_config(f"[sensor]\n{text}\n", "x.toml")


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
