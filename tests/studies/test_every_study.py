"""Every study runs, in its smallest form, and what it leaves can be read back and drawn.

They run with the long tests; the kept results are drawn.
"""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import pytest

from scripts.studies.document_pictures import pictures_of
from scripts.studies.documents import documents, result_of
from scripts.studies.registry import STUDIES
from scripts.studies.result import Result, read_result, run_study
from scripts.studies.study import Study
from tests.effort import every

ROOT = Path(__file__).parents[2]
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


@pytest.mark.long
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

    assert_drawn(again, tmp_path)


def assert_drawn(result: Result, folder: Path) -> None:
    """All figures of a result are pictures of some content."""
    for name, figure in result.figures().items():
        assert name.startswith(result.study.name)
        figure.savefig(folder / f"{name}.png")
        assert (folder / f"{name}.png").stat().st_size > 5000


@pytest.mark.parametrize("name", every(3, [each.name for each in STUDIES if each.pictures]))
def test_a_kept_result_is_drawn(name: str, tmp_path: Path) -> None:
    assert_drawn(result_of(ROOT, name), tmp_path)


def test_a_page_shows_every_picture_of_a_study() -> None:
    """A picture that no page shows serves nobody."""
    shown = {(study, picture) for page in documents(ROOT) for study, picture, _ in pictures_of(page)}
    drawn = [(each.name, name) for each in STUDIES if each.pictures
             for name in each.figures(result_of(ROOT, each.name).findings)]  # fmt: skip
    assert set(drawn) == shown


def test_names_are_sorted_and_questions_are_sentences() -> None:
    names = [study.name for study in STUDIES]
    assert names == sorted(set(names))
    assert [study.name for study in STUDIES if not study.question.endswith("?") or study.seconds <= 0.0] == []


def test_pages_of_studies_are_there() -> None:
    docs = ROOT / "docs"
    assert [study.page for study in STUDIES if study.page and not (docs / study.page.partition("#")[0]).is_file()] == []
