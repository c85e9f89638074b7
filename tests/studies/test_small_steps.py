"""Steps of studies that are small enough to be known: cases by name, densities, cells of the book, gauges."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from scripts.studies.book import Measure, cells, measure, row_of, short_cell
from scripts.studies.cases import class_cases, named_cases, of_masses
from scripts.studies.criteria.study import BINS_M_S, criteria, density_of
from scripts.studies.degree.study import CaseRow, Degrees, Row
from scripts.studies.estimator.pair import as_tuned
from scripts.studies.side_by_side import side_by_side
from synth.configuration.config_file import load_config
from synth.frame.input_error import InputError
from synth.problem.aim import Aim
from synth.problem.criterion import SQUARED_ERROR_CRITERION
from synth.problem.problem import Problem
from synth.simulation.closed_loop import TableController
from tests.synth.case_factory import make_sample


def test_cases_are_found_by_mass_and_target() -> None:
    config = load_config(None)
    (light, heavy) = named_cases(config, ("22:2", "85:3.5"))
    assert (light.name, heavy.name) == ("22 t to 2 m/s", "85 t to 3.5 m/s")
    assert light.plant.cut.mass_t == 22.0
    assert [case.name for case in class_cases(config, (52.0,), ())] == [f"52 t to {v} m/s" for v in (2, 3, 4)]
    assert len(class_cases(config, (), (1.5,))) == 5


@pytest.mark.parametrize("word", ["22", "22:", ":2", "23:2", "22:2:2", "a:b"])
def test_a_wrong_case_is_told_with_the_masses_known(word: str) -> None:
    with pytest.raises(InputError, match=r"give MASS:TARGET as in 22:2, the mass one of 22, 36, 52, 66, 85 t"):
        named_cases(load_config(None), (word,))
    with pytest.raises(InputError, match=r"no cut of the configuration has 23 t; its masses are 22, 36, 52, 66, 85 t"):
        of_masses(load_config(None), (22.0, 23.0))


def test_work_side_by_side_keeps_its_order() -> None:
    assert side_by_side(lambda x: x * x, range(20), threads=3) == tuple(x * x for x in range(20))


def test_the_density_of_errors_is_a_density() -> None:
    sample = make_sample(3.0, 0.05, 1)
    density = np.array(density_of(sample, 3.0))
    error = sample.exit_speed_m_s - 3.0
    inside = (error >= BINS_M_S[0]) & (error <= BINS_M_S[-1])
    share = float(sample.weight[inside].sum() / sample.weight.sum())
    assert float(density @ np.diff(BINS_M_S)) == pytest.approx(share)
    assert share > 0.99
    middle = 0.5 * (np.array(BINS_M_S[1:]) + np.array(BINS_M_S[:-1]))
    assert float(density @ (middle * np.diff(BINS_M_S))) == pytest.approx(float(error.mean()), abs=0.006)


def test_every_criterion_differs_from_the_default_in_one_thing() -> None:
    asked = criteria(SQUARED_ERROR_CRITERION)
    assert asked["default"] is SQUARED_ERROR_CRITERION
    for name, each in asked.items():
        changed = [key for key in vars(each) if getattr(each, key) != getattr(SQUARED_ERROR_CRITERION, key)]
        assert changed == {"default": [], "over-speed ×4": ["terminal"]}.get(name, ["requirement"])


CASE: dict[str, Any] = {
    "label": "gondola-4-66t",
    "target_speed_m_s": 2.0,
    "feasible": False,
    "simulated": {
        "rms_m_s": 0.13817, "rms_ci95_m_s": [0.13541, 0.14119], "p95_m_s": 0.05, "p95_ci95_m_s": [0.04, 0.06],
        "p99_m_s": 0.7, "p99_ci95_m_s": [0.6, 0.8], "predicted_rms_m_s": 0.14,
    },
    "brake_power": {
        "out_of_brake": 0.0182, "out_of_brake_ci95": [0.0172, 0.0193],
        "rms_within_m_s": 0.03, "rms_within_ci95_m_s": [0.02, 0.04],
    },
    "honesty": 1.01, "honesty_ci95": [0.99, 1.03],
    "regret": None, "regret_ci95": [None, None], "best_baseline": "energy rule",
    "comparison": {"energy rule": {"rms_m_s": 0.114, "rms_ci95_m_s": [0.112, 0.116]}},
    "off_nominal": {
        "friction_low": {
            "name": "friction × 0.7", "rms_m_s": 0.4, "rms_ci95_m_s": [0.39, 0.41], "overspeed": 0.2, "stalled": 0.0,
        },
        "readings_lost": {"name": "a third lost", "impossible": "no"},
    },
}  # fmt: skip


def test_a_row_of_the_book_is_that_of_its_summary() -> None:
    row = row_of(CASE)
    assert short_cell(row) == "0.1382 [0.1354, 0.1412]°; 182"
    assert short_cell(replace(row, feasible=True)) == "0.1382 [0.1354, 0.1412]; 182"
    assert (row.honesty.value, row.honesty.ci95) == (1.01, (0.99, 1.03))
    assert (row.regret, cells(row)[9]) == (None, "–")
    assert cells(row_of({**CASE, "regret": 1.1, "regret_ci95": [1.0, 1.2]}))[9] == "1.100 [1.000, 1.200]"
    assert [each.name for each in row.off_nominal] == ["friction × 0.7"]
    assert row.off_nominal[0].rms == Measure(0.4, (0.39, 0.41))
    assert row.baseline_rms == measure(CASE["comparison"]["energy rule"], "rms_m_s")


def test_a_wrong_gauge_scales_the_brake_work_and_nothing_else() -> None:
    config = load_config(None)
    (case,) = named_cases(config, ("22:3",))
    pair = as_tuned(Problem(case.plant, Aim(case.target_m_s, config.criterion)), config, case.label)
    wrong = pair.misled(1.15)
    assert isinstance(wrong, TableController)
    assert isinstance(pair.estimated, TableController)
    told, own = wrong.table.estimator, pair.estimated.table.estimator
    assert told is not None
    assert own is not None
    assert told.brake_m2_s2_per_kpa == tuple(1.15 * work for work in own.brake_m2_s2_per_kpa)
    assert replace(told, brake_m2_s2_per_kpa=own.brake_m2_s2_per_kpa) == own
    assert replace(wrong.table, estimator=own) == pair.estimated.table
    assert pair.misled(1.0) is pair.estimated


def test_a_degree_that_makes_no_table_is_told() -> None:
    def row(degree: int, ratio: float) -> Row:
        return Row(degree, 0.05, 0.04, 0.041, (0.04, 0.042), 0.0, 0.04, ratio, (ratio - 0.01, ratio + 0.01))

    case = CaseRow("case", (row(1, 1.05), row(3, 1.0), row(0, 1.2)))
    found = Degrees("0", 1, 200, (1, 3, 5), (case,))
    cells = found.tables()["ratio"].rows[0]
    assert cells == ("case", "1.050 ± 0.010", "1", "no table", "1.200 ± 0.010")
    assert found.tables()["rms"].rows[0][1] == "40.0 / 41.00 ± 1.00"
    assert found.tables()["polish"].rows[0] == ("case", "1.25", "1.25", "no table")
