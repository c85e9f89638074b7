"""One small case through the whole chain, and the pieces that only it has: bound, map, feasibility."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from synth.frame.workers.engine import Teller
from synth.retarder.case_result import CaseResult
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.estimation.estimate_chain import estimate_chain
from synth.retarder.policy_map import policy_map, share_of_ties
from synth.retarder.radar_epochs import RadarEpochs
from synth.retarder.tune import Book, tune
from synth.simulation.passes import TRACE_FACTORS
from synth.solver.backward_induction import solve
from tuning_tables import ControllerTable, read_json, write_json

SMALL = """
[[cut]]
car = "gondola-4"
mass_t = 52.0
[targets]
exit_speeds_m_s = [3.0, 4.0]
[grid]
path_step_m = 0.5
speed_step_m_s = 0.05
friction_scenarios = 4
resistance_scenarios = 3
[validation]
passes = 4000
"""


def stored(table: ControllerTable, directory: Path) -> ControllerTable:
    """The table as it is read back from a file in `directory`."""
    write_json(table, directory / f"{table.id}.json")
    return read_json(directory / f"{table.id}.json")


@pytest.fixture(scope="module")
def directory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("tables")


@pytest.fixture(scope="module")
def book(directory: Path) -> Book[CaseResult]:
    said: list[str] = []
    store = partial(stored, directory=directory)
    result = tune(parse_config(SMALL, "small.toml"), RadarEpochs(), store, Teller(said.append), workers=2)
    assert any("to 4 m/s" in sentence for sentence in said)
    return result


@pytest.fixture
def case(book: Book[CaseResult]) -> CaseResult:
    return book.cases[0]


@pytest.mark.requirement("PRED-06")
def test_the_table_on_disk_is_the_one_that_was_validated(book: Book[CaseResult], directory: Path) -> None:
    assert sorted(p.name for p in directory.iterdir()) == sorted(f"{c.table.id}.json" for c in book.cases)
    for case in book.cases:
        assert read_json(directory / f"{case.table.id}.json") == case.table
        assert case.table.validated is not None
        assert case.table.validated.rms_m_s == case.statistics.rms_m_s
        assert json.loads((directory / f"{case.table.id}.json").read_bytes())["generator"]["name"] == "retarder-synth"


def test_the_prediction_is_honest_and_who_is_told_the_friction_is_no_worse(book: Book[CaseResult]) -> None:
    for case in book.cases:
        figures, table = case.comparison, case.measured
        assert table.statistics.rms_m_s < 0.06
        assert 0.85 < table.predicted_rms_m_s / table.statistics.rms_m_s < 1.15
        told = figures.friction_known
        assert told.statistics.rms_m_s * figures.regret == pytest.approx(table.statistics.rms_m_s)
        assert told.table_ratio >= 1.0  # who is told the friction is no worse, and need not use it
        assert told.table_ratio_ci95[1] < 1.3
        assert told.table_ratio_ci95[1] - told.table_ratio_ci95[0] < 0.1  # on the same passes
        assert len(case.controllers) == 4


def test_the_map_agrees_with_the_lines_and_marks_indifference(case: CaseResult) -> None:
    """Far above its line a stage goes up, far below down, wherever that counts."""
    config = parse_config(SMALL, "small.toml")
    chain = estimate_chain(case.plant, config.resolution_of(case.plant), config.lowest_target_m_s)
    solution = solve(chain, config.aims_of(case.label)[0])
    chart, lines = policy_map(solution, 1e-4), solution.lines
    assert chart.command.shape == chart.indifferent.shape == (5, len(chart.path_m), len(chart.speed_m_s))
    assert not (chart.command[0] == -1).any()
    assert not (chart.command[-1] == 1).any()
    upper, lower = (each[:, : len(chart.path_m), None] for each in (lines.upper_m_s, lines.lower_m_s))
    above = (chart.speed_m_s > upper + 0.1) & (chart.speed_m_s < upper + 0.5)
    below = (chart.speed_m_s < lower - 0.1) & (chart.speed_m_s > lower - 0.5)
    for near, command in ((above, 1), (below, -1)):
        counts = near & ~chart.indifferent
        assert counts.sum() > 0.1 * near.sum() > 100
        assert (chart.command[counts] == command).all()
        assert (chart.command[near] == command).mean() > 0.8
    assert 0.0 < chart.indifferent.mean() < 1.0
    assert 0.0 < share_of_ties(solution) < chart.indifferent.mean()


def test_feasibility_falls_with_entry_speed(case: CaseResult) -> None:
    found = case.feasibility
    assert not case.unavoidable.forbids(found.limit_m_s)
    assert found.served_m_s is not None
    assert found.served_m_s[0] < case.target_speed_m_s  # downhill a slower cut reaches it too
    assert found.entry_rms_m_s[-1] > found.entry_rms_m_s[len(found.entry_m_s) // 2]


def test_no_controller_of_a_case_has_less_than_the_unavoidable_error(book: Book[CaseResult]) -> None:
    for case in book.cases:
        least = case.unavoidable.rms_m_s
        assert 0.0 < least < min(entry.statistics.rms_m_s for entry in case.controllers)


def test_traces_are_passes_of_the_exported_table(case: CaseResult) -> None:
    for trace, factor in zip(case.traces, TRACE_FACTORS, strict=True):
        assert trace.exit_speed_m_s == pytest.approx(case.target_speed_m_s, abs=0.3), factor
        assert np.all(np.diff(trace.path_m) >= 0.0)
