"""Every study runs, in its smallest form, and what it leaves can be read back and drawn."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import pytest

from scripts.studies.registry import STUDIES
from scripts.studies.result import read_result, run_study
from scripts.studies.study import Study

COARSE = """\
[targets]
exit_speeds_m_s = [2.0, 3.0]
[grid]
path_step_m = 1.0
speed_step_m_s = 0.05
transient_step_s = 0.1
friction_scenarios = 2
resistance_scenarios = 1
[validation]
passes = 1000
"""
"""Of the built-in configuration two targets on a coarse grid: a study goes through all its steps on any grid."""


def smallest(study: Study, folder: Path) -> Any:
    """The smallest options of `study`, with the coarse configuration where it takes one."""
    options = study.method.smallest
    if "config" not in {field.name for field in fields(options)}:
        return options
    (folder / "coarse.toml").write_text(COARSE, encoding="utf-8")
    return replace(options, config=folder / "coarse.toml")


@pytest.mark.slow
@pytest.mark.parametrize("study", STUDIES, ids=lambda study: study.name)
def test_a_study_runs_and_its_result_reads_back(study: Study, tmp_path: Path) -> None:
    told: list[str] = []
    result = run_study(study, smallest(study, tmp_path), told.append)
    assert told, "nobody sees how far it is"
    tables = result.findings.tables()
    assert tables
    assert all(each.rows for each in tables.values())
    assert all(each.markdown() in result.markdown() for each in tables.values())

    path = tmp_path / f"{study.name}.json"
    path.write_text(result.json(), encoding="utf-8")
    again = read_result(study, path)
    assert again == result
    assert again.json() == result.json()
    assert again.findings.tables() == tables

    for name, figure in again.figures().items():
        assert name.startswith(study.name)
        figure.savefig(tmp_path / f"{name}.png")
        assert (tmp_path / f"{name}.png").stat().st_size > 5000


def test_names_are_sorted_and_questions_are_sentences() -> None:
    names = [study.name for study in STUDIES]
    assert names == sorted(set(names))
    assert [study.name for study in STUDIES if not study.question.endswith("?") or study.seconds <= 0.0] == []


def test_pages_of_studies_are_there() -> None:
    docs = Path(__file__).parents[2] / "docs"
    assert [study.page for study in STUDIES if study.page and not (docs / study.page.partition("#")[0]).is_file()] == []
