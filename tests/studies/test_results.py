"""The JSON of a study holds all of its result; what another study, or another version of it, left is refused."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest

from scripts.studies import study as study_module
from scripts.studies.markdown_table import MarkdownTable, table
from scripts.studies.options import option
from scripts.studies.result import Result, read_result, run_study
from scripts.studies.study import Findings, Method, Study
from synth.frame.input_error import InputError


@dataclass(frozen=True)
class Options:
    """Of a study that counts."""

    passes: int = option(10, "how many")


@dataclass(frozen=True)
class Row:
    """A case, an interval, something that may be absent."""

    case: str
    ends: tuple[float, float]
    ratio: float | None


@dataclass(frozen=True)
class Counted(Findings):
    """What counting finds."""

    rows: tuple[Row, ...]
    shares: dict[str, float]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """One row a case."""
        return {"rows": table("rows", ("case", "low"), ((row.case, f"{row.ends[0]:g}") for row in self.rows))}


FOUND = Counted((Row("a [b, c] ü", (0.1, 1e-17), None), Row("d", (-1.0, 2.0), 0.5)), {"rms": 1.0 / 3.0})
METHOD = Method(Options, Options(1), Counted, lambda options, tell: FOUND)


@pytest.fixture
def study(monkeypatch: pytest.MonkeyPatch) -> Study:
    monkeypatch.setattr(study_module, "import_module", lambda name: __import__("types").SimpleNamespace(METHOD=METHOD))
    return Study("counted", "How many?", 1.0, "", "nowhere")


def left(study: Study, path: Path, changes: dict[str, Any]) -> Path:
    document = json.loads(run_study(study).json()) | changes
    (path / "counted.json").write_text(json.dumps(document), encoding="utf-8")
    return path / "counted.json"


def test_a_result_is_read_back_with_every_bit_and_type(study: Study, tmp_path: Path) -> None:
    result = run_study(study, Options(7))
    (tmp_path / "counted.json").write_text(result.json(), encoding="utf-8")
    again = read_result(study, tmp_path / "counted.json")
    assert again == result
    assert again.options == Options(7)
    assert isinstance(again.findings, Counted)
    assert again.findings.rows[0].ends == (0.1, 1e-17)
    assert again.markdown() == result.markdown()


def test_numbers_of_a_list_stand_in_one_line(study: Study) -> None:
    assert '"ends": [0.1, 1e-17],\n' in run_study(study).json()
    assert '"case": "a [b, c] ü",\n' in run_study(study).json()


@pytest.mark.parametrize(
    "changes",
    [
        {"study": "other"},
        {"version": 2},
        {"findings": {"rows": [], "shares": {}, "more": 1}},
        {"findings": {"rows": [{"case": "a", "ends": [1.0], "ratio": None}], "shares": {}}},
        {"findings": {"rows": [{"case": "a", "ends": ["x", 1.0], "ratio": None}], "shares": {}}},
        {"options": {"passes": 10, "more": 1}},
        {"options": {}},
    ],
)
def test_what_no_run_left_is_refused(study: Study, tmp_path: Path, changes: dict[str, Any]) -> None:
    path = left(study, tmp_path, changes)
    with pytest.raises(InputError, match=r"counted\.json: .*study counted' again"):
        read_result(study, path)


def test_a_missing_or_broken_file_is_told(study: Study, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no such file; 'retarder-synth study counted' makes it"):
        read_result(study, tmp_path / "counted.json")
    (tmp_path / "counted.json").write_text("{", encoding="utf-8")
    with pytest.raises(InputError, match="Expecting property name"):
        read_result(study, tmp_path / "counted.json")


def test_a_number_that_is_not_finite_is_no_result(study: Study) -> None:
    broken = replace(FOUND, shares={"rms": math.nan})
    with pytest.raises(ValueError, match="Out of range float"):
        Result(study, "1", Options(), broken).json()
