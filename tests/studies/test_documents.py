"""Every study runs, its result reads back, and every marked table of the documentation is that of its study."""

from __future__ import annotations

import re
import shutil
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import pytest

from scripts.studies.document_parts import pictures_of
from scripts.studies.documents import DATA, KEPT, documents, filled, listed, result_of, stale, written
from scripts.studies.registry import STUDIES
from scripts.studies.result import Result, read_result, run_study
from scripts.studies.study import Study
from synth.frame.faults import InputError
from tests.effort import every

ROOT = Path(__file__).parents[2]
KEPT_NAMES = sorted(path.stem for path in (ROOT / KEPT).glob("*.json"))
TOLD = {"every-cut": 2, "point-sensors": 1}
"""How many cases their pages tell in which a claim does not hold."""


def test_every_marked_table_is_that_of_its_study() -> None:
    assert stale(ROOT) == []


def test_kept_results_are_those_of_known_studies_and_have_a_page() -> None:
    assert set(KEPT_NAMES) <= {study.name for study in STUDIES}
    assert sorted(path.stem for path in (ROOT / DATA).glob("*.md")) == sorted(["index", *KEPT_NAMES])


def test_a_page_of_data_is_written_where_it_is_missing(checkout: Path) -> None:
    missing = checkout / DATA / f"{KEPT_NAMES[0]}.md"
    text = missing.read_text(encoding="utf-8")
    missing.unlink()
    assert stale(checkout) == [
        f"{missing.relative_to(checkout)}: its tables are not those of docs/studies; "
        "'retarder-synth study --document' writes them"
    ]
    assert written(checkout) == [missing]
    assert missing.read_text(encoding="utf-8") == text


@pytest.mark.parametrize("name", KEPT_NAMES)
def test_a_kept_result_was_run_with_the_options_of_the_documentation_and_holds_its_claims(name: str) -> None:
    result = result_of(ROOT, name)
    assert result.options == result.study.method.options()
    assert len(result.findings.faults()) == TOLD.get(name, 0)


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    for folder in (KEPT, DATA):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    (tmp_path / "README.md").write_text("nothing\n", encoding="utf-8")
    return tmp_path


def page(checkout: Path, text: str) -> Path:
    path = checkout / "docs" / "page.md"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_stale_table_is_found_and_mended(checkout: Path) -> None:
    name = KEPT_NAMES[0]
    shown, each = next(iter(result_of(ROOT, name).findings.tables().items()))
    mark = f"<!-- study {name} {shown} -->\n"
    path = page(checkout, f"before\n{mark}| wrong |\n<!-- end -->\n<!-- studies -->\n<!-- end -->\nafter\n")
    assert stale(checkout) == [
        "docs/page.md: its tables are not those of docs/studies; 'retarder-synth study --document' writes them"
    ]
    assert written(checkout) == [path]
    studies = f"<!-- studies -->\n{listed(path.parent, checkout)}<!-- end -->\n"
    expected = f"before\n{mark}{each.markdown()}<!-- end -->\n{studies}after\n"
    assert path.read_text(encoding="utf-8") == expected
    assert stale(checkout) == []
    assert written(checkout) == []


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("<!-- study {0} {1} -->\n| a |\n<!-- study {0} {1} -->\n<!-- end -->\n", "has no <!-- end --> behind it"),
        ("<!-- study {0}x {1} -->\n<!-- end -->\n", "did you mean {0}?"),
        ("<!-- study {0} {1}x -->\n<!-- end -->\n", "has no table '{1}x'"),
    ],
)
def test_a_wrong_mark_is_told(checkout: Path, text: str, sentence: str) -> None:
    name = KEPT_NAMES[0]
    shown = next(iter(result_of(ROOT, name).findings.tables()))
    path = page(checkout, text.format(name, shown))
    with pytest.raises(InputError, match=re.escape(sentence.format(name, shown))):
        filled(path, checkout)


def test_elsewhere_than_in_a_checkout_nothing_is_filled(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="run the command in a checkout"):
        written(tmp_path)


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
