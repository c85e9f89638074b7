"""The studies of sensor faults and of every cut: cases and faults are what they say."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.stats import binom

from plant_models import Plant
from plant_models.library import car_names, load_car, load_position, position_names
from scripts.studies.changed_plants import DropOut, LostForGood, LostReadings, at_random, reading_times_s
from scripts.studies.every_cut.cut_figures import (
    CARS_OF_A_CUT,
    Beside,
    BesideWithout,
    CutFigures,
    Outcome,
    RandomCase,
    Untuned,
    random_case,
)
from scripts.studies.every_cut.measured_case import KeptCases, measured
from scripts.studies.every_cut.study import Options, configuration, faults_of, median_interval
from synth.retarder.comparison.baselines import energy_rule
from synth.retarder.configuration.config_file import parse_config
from synth.simulation.closed_loop import TableController, close_loop, simulate, trace
from synth.simulation.exit_statistics import clopper_pearson
from synth.simulation.passes import PassTrace
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.solver.descent import one_blas_thread
from tests.effort import sized
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


NUMBERS = range(sized(100, 400))
MANY = [random_case(5, number) for number in NUMBERS]


def test_a_case_depends_on_seed_and_number_alone() -> None:
    assert [random_case(5, number) for number in reversed(NUMBERS)] == MANY[::-1]
    assert random_case(6, 17) != replace(MANY[17], number=17)
    assert len({replace(case, number=0) for case in MANY}) == len(NUMBERS)
    assert random_case(20_261_124, 0) == RandomCase(0, "knp-5-bunch", "hopper-4", 4, 288.5, 3.5)


def test_every_position_car_and_number_of_cars_occurs() -> None:
    assert {case.position for case in MANY} == set(position_names())
    assert {case.car for case in MANY} == set(car_names())
    assert {case.cars for case in MANY} == set(CARS_OF_A_CUT)


def test_cases_are_ordinary() -> None:
    for case in MANY:
        position, car = load_position(case.position), load_car(case.car)
        (targets,) = (value for value in position.provenance if value.key == "targets.exit_speeds_m_s")
        assert targets.range is not None
        assert targets.range[0] <= case.target_m_s <= targets.range[1]
        assert min(position.target_speeds_m_s) - 0.2001 <= case.target_m_s <= max(position.target_speeds_m_s)
        assert case.target_m_s < position.entry.low_m_s
        each_t = case.mass_t / case.cars
        assert max(23.0, car.car.tare_t) - 0.05 <= each_t <= min(84.0, car.car.gross_t) + 0.05
        assert (case.mass_t, case.target_m_s) == (round(case.mass_t, 1), round(case.target_m_s, 1))


def test_the_configuration_of_a_case_is_that_of_a_user() -> None:
    case = RandomCase(3, "rnz-2m-park", "tank-8", 2, 120.5, 1.9)
    config = parse_config(configuration(case, Options(seed=100, passes=2000)), "a case")
    ((_, plant),) = config.plants()
    assert (config.retarder.name, config.targets_m_s) == ("rnz-2m-park", (1.9,))
    assert (config.validation.passes, config.validation.seed) == (2000, 130)
    assert (plant.cut.mass_t, len(plant.cut.axle_offsets_m)) == (120.5, 16)
    assert config.grid == parse_config("", "nothing").grid
    assert parse_config(configuration(case, Options(coarse=True)), "a case").grid.path_step_m == 1.0


RULE = Beside("energy rule", 0.1, 5.0, 1.0, (0.99, 1.01))
WITHOUT = BesideWithout(0.8, (0.79, 0.81), 0.9, (0.89, 0.91))
SOUND = CutFigures(MANY[0], 76.0, 0.1, (0.095, 0.105), 0.1, False, 6.0, True, RULE, WITHOUT)


@pytest.mark.parametrize("count", [6, 7, 10, 20, 101, 500])
def test_the_interval_of_a_median_is_the_shortest_that_the_binomial_law_allows(count: int) -> None:
    ends = median_interval(range(1, count + 1))
    assert ends is not None
    low, high = ends
    assert low + high == count + 1
    wider, narrower = (2.0 * float(binom.cdf(k, count, 0.5)) for k in (low - 1, low))
    assert wider <= 0.05 < narrower


def test_five_values_tell_no_interval_of_their_median() -> None:
    assert median_interval(range(5)) is None


def test_a_finished_case_is_not_done_again(tmp_path: Path) -> None:
    file = tmp_path / "every-cut.jsonl"
    made: list[str] = []

    def outcome_of(text: str, found: Outcome) -> Outcome:
        def make() -> Outcome:
            made.append(text)
            return found

        return KeptCases(file).outcome_of(text, make)

    refused = Untuned(MANY[1], "no")
    assert [outcome_of("a", SOUND), outcome_of("b", refused)] == [SOUND, refused]
    file.write_bytes(file.read_bytes() + b'{"torn')
    assert [outcome_of("a", refused), outcome_of("b", SOUND)] == [SOUND, refused]
    assert outcome_of("c", SOUND) == SOUND
    assert made == ["a", "b", "c"]


@pytest.mark.parametrize("changed", ["software_sha256", "studies_sha256"])
def test_what_another_software_has_found_is_not_taken(
    changed: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "every-cut.jsonl"
    assert KeptCases(file).outcome_of("a", lambda: SOUND) == SOUND
    monkeypatch.setattr(f"scripts.studies.every_cut.measured_case.{changed}", lambda: "another")
    other = replace(SOUND, rms_m_s=0.2)
    assert KeptCases(file).outcome_of("a", lambda: other) == other


@one_blas_thread()
def test_the_table_of_an_ordinary_cut_is_no_worse_than_a_rule() -> None:
    case = random_case(8, 4)  # a long pass through a bunch position
    found = measured(case, parse_config(case.text(2000, 1), case.name))
    assert isinstance(found, CutFigures), found
    assert list(faults_of(found)) == []
    assert 0.9 < found.prediction_ratio < 1.1
