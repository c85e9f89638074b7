"""Random cases lie where they say, what is kept is what was found, and an ordinary cut is better off with a table."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from scipy.stats import binom

from plant_models.library import car_names, load_car, load_position, position_names
from scripts.studies.every_cut.cut_figures import Beside, BesideWithout, CutFigures, Outcome, Untuned
from scripts.studies.every_cut.findings import faults_of
from scripts.studies.every_cut.kept_cases import KeptCases
from scripts.studies.every_cut.measured_case import measured
from scripts.studies.every_cut.order_statistics import median_interval
from scripts.studies.every_cut.random_case import CARS_OF_A_CUT, RandomCase, random_case
from scripts.studies.every_cut.study import Options, configuration
from synth.retarder.configuration.config_file import parse_config
from synth.solver.one_blas_thread import one_blas_thread
from tests.effort import sized

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
    monkeypatch.setattr(f"scripts.studies.every_cut.kept_cases.{changed}", lambda: "another")
    other = replace(SOUND, rms_m_s=0.2)
    assert KeptCases(file).outcome_of("a", lambda: other) == other


@one_blas_thread()
def test_the_table_of_an_ordinary_cut_is_no_worse_than_a_rule() -> None:
    case = random_case(8, 4)  # a long pass through a bunch position
    found = measured(case, parse_config(case.text(2000, 1), case.name))
    assert isinstance(found, CutFigures), found
    assert list(faults_of(found)) == []
    assert 0.9 < found.prediction_ratio < 1.1
