"""Sensor faults: a missing reading is a HOLD, a bias is a shift of the lines, and drop-outs lie where they should."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models import Plant
from scripts.studies.sensor_fault import (
    DropOut,
    LostForGood,
    LostReadings,
    at_random,
    reading_times_s,
)
from synth.retarder.comparison.baselines import energy_rule
from synth.simulation.closed_loop import TableController, close_loop, simulate, trace
from synth.simulation.exit_statistics import clopper_pearson
from synth.simulation.passes import PassTrace
from synth.simulation.random_passes import RandomPasses, random_passes
from tests.synth.case_factory import make_plant, make_table


@pytest.fixture(scope="module")
def passes() -> RandomPasses:
    return random_passes(seed=12, first_pass=0, count=400)


@pytest.fixture(scope="module")
def plant() -> Plant:
    return make_plant(36.0, 4)


@pytest.fixture(scope="module")
def controller(plant: Plant) -> TableController:
    return TableController(make_table("test", plant, 3.0))


def from_moment(start_s: float) -> Callable[[np.ndarray], np.ndarray]:
    return lambda transit_s: np.full(transit_s.shape, start_s)


def missing(passes: RandomPasses) -> np.ndarray:
    return np.isnan(passes.noise_z)


# -------------------------------------------------------------------------------- missing readings


def test_no_command_is_given_in_a_drop_out(plant: Plant, controller: TableController, passes: RandomPasses) -> None:
    transit, commanded, later = np.zeros(len(passes)), 0, 0
    start, length = 2.0, 2.0
    blind = DropOut(length, from_moment(start))(passes, plant, transit)
    for i in range(20):
        healthy, faulty = trace(plant, controller, passes, i), trace(plant, controller, blind, i)

        def commands_s(found: PassTrace) -> NDArray[np.float64]:
            changes: NDArray[np.bool_] = np.diff(found.stage) != 0
            return found.time_s[1:][changes]

        times = commands_s(faulty)
        assert not np.any((times >= start) & (times < start + length))
        assert np.array_equal(times[times < start], commands_s(healthy)[commands_s(healthy) < start])
        commanded += int(np.count_nonzero((commands_s(healthy) >= start) & (commands_s(healthy) < start + length)))
        later += int(np.count_nonzero(times >= start + length))
    assert commanded > 10  # the fault had something to hide
    assert later > 10  # and the controller comes back


def test_a_sensor_lost_for_good_does_not_come_back(plant: Plant, passes: RandomPasses) -> None:
    """Random numbers of readings repeat after 25.6 s; a cut that hangs in the retarder would see again."""
    few, start = passes.part(0, 5), 2.0
    lost = LostForGood(from_moment(start))(few, plant, np.zeros(5))
    time, missing = reading_times_s(lost, plant), np.isnan(lost.noise_z)
    assert time[:, -1].min() > 299.0
    assert np.array_equal(missing, time >= start)
    assert np.array_equal(lost.noise_z[:, :15], few.noise_z[:, :15])
    back = DropOut(1e9, from_moment(start))(few, plant, np.zeros(5))
    assert back.noise_z.shape[1] == 256  # the reason for more of them


def test_a_missing_reading_does_not_spoil_the_slope_for_ever(plant_52t: Plant, passes: RandomPasses) -> None:
    loop = close_loop(plant_52t, 5)
    controller = energy_rule(loop, 3.0, 4, 0.8, 0.15, 0.25, 0.15)
    assert controller.lead_s > 0.0
    blind = DropOut(0.15, from_moment(1.0))(passes, plant_52t, np.zeros(len(passes)))
    healthy, faulty = (simulate(plant_52t, controller, x) for x in (passes, blind))
    # A slope that stayed NaN would end all commands one second after the entrance.
    assert faulty.switchings.mean() > 0.8 * healthy.switchings.mean()
    assert abs(np.median(faulty.exit_speed_m_s) - np.median(healthy.exit_speed_m_s)) < 0.1


# ------------------------------------------------------------------------------------------- bias


# ------------------------------------------------------------------------------------------- where they lie


def test_drop_outs_lie_in_the_pass_and_longer_ones_hold_shorter_ones(plant: Plant, passes: RandomPasses) -> None:
    transit = np.linspace(8.0, 12.0, len(passes))
    found = [missing(DropOut(x, at_random(3))(passes, plant, transit)) for x in (0.2, 0.5, 1.0)]
    time = reading_times_s(passes, plant)
    for gone, count in zip(found, (2, 5, 10), strict=True):
        assert set(gone.sum(axis=1).tolist()) <= {count - 1, count, count + 1}
        assert gone.sum(axis=1).mean() == pytest.approx(count, abs=0.1)
        assert np.all(time[gone.any(axis=1), :][gone[gone.any(axis=1)]] <= transit.max() + 1.0)
    assert np.all(found[0] <= found[1])
    assert np.all(found[1] <= found[2])
    middle = np.array([time[i, gone].mean() for i, gone in enumerate(found[0])]) / transit
    assert abs(middle.mean() - 0.5) < 4.0 * np.sqrt(1.0 / 12.0 / len(passes)) + 0.01


def test_lost_readings_are_as_many_as_asked_for(plant: Plant, passes: RandomPasses) -> None:
    gone = missing(LostReadings(0.3, seed=4)(passes, plant, np.zeros(len(passes))))
    low, high = clopper_pearson(int(gone.sum()), gone.size, 0.9999)
    assert low < 0.3 < high


def test_faults_do_not_depend_on_how_many_passes_are_drawn(plant: Plant, passes: RandomPasses) -> None:
    transit = np.full(len(passes), 9.0)
    few = passes.part(0, 50)
    for fault in (DropOut(0.5, at_random(3)), LostReadings(0.2, seed=5)):
        whole = fault(passes, plant, transit).noise_z[:50]
        assert np.array_equal(fault(few, plant, transit[:50]).noise_z, whole, equal_nan=True)
