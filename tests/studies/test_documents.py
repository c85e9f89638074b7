"""Every marked table of the documentation is that of the kept result of its study."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from scripts.studies.documents import DATA, KEPT, filled, listed, result_of, stale, written
from scripts.studies.registry import STUDIES
from synth.frame.input_error import InputError

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
