"""`retarder-synth study`: a light list, one sentence for a wrong word, files and JSON of the same run."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from scripts.studies.registry import STUDIES
from scripts.studies.result import read_result
from synth.cli import main
from synth.cli.study import laboratory
from tests.frame.results import results_in

ROOT = Path(__file__).parents[2]


def test_the_list_names_question_and_time_of_every_study(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "--list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == len(STUDIES)
    for line, study in zip(lines, STUDIES, strict=True):
        assert line.split()[0] == study.name
        assert line.endswith(study.question)
        assert study.duration in line
    assert main(["study", "--list", "--json"]) == 0
    assert [each["name"] for each in json.loads(capsys.readouterr().out)["studies"]] == [s.name for s in STUDIES]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["study"], "study: which one?"),
        (["study", "interpolatoin"], "did you mean interpolation?"),
        (["study", "interpolation", "--passes", "1"], "--passes: it is '1'; give a whole number from 200 to"),
        (["study", "interpolation", "--masses-t", "23"], "no cut of the configuration has 23 t"),
        (["study", "interpolation", "--config", "nowhere.toml"], "nowhere.toml: there is no such file"),
        (["study", "interpolation", "--small", "--passes", "300"], "--small has options of its own"),
        (["study", "interpolation", "--check"], "leave the name of a study out"),
    ],
)
def test_a_wrong_word_is_told(words: list[str], sentence: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words) == 2
    told = capsys.readouterr()
    assert sentence in told.err
    assert (told.out, told.err.count("\n")) == ("", 1)


def test_the_help_of_a_study_tells_its_options(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "interpolation", "--help"]) == 0
    assert "--masses-t X [X ...]" in capsys.readouterr().out
    assert main(["study", "--help"]) == 0
    assert "Run a study" in capsys.readouterr().out


def test_a_run_leaves_its_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["study", "interpolation", "--masses-t", "22", "--passes", "200", "--parts", "2", "--step-m-s", "2"]
    assert main([*words, "-o", str(tmp_path), "--json"]) == 0
    study = next(each for each in STUDIES if each.name == "interpolation")
    result = read_result(study, tmp_path / "interpolation.json")
    assert capsys.readouterr().out == result.json()
    assert (tmp_path / "interpolation.md").read_text(encoding="utf-8") == result.markdown()
    assert {Path(name).suffix for name in results_in(tmp_path)} == {".json", ".md"}


def test_the_product_alone_says_where_studies_are(tmp_path: Path) -> None:
    """What a wheel holds, copied to a place of its own: -S keeps the checkout that is installed out of the path."""
    for package in ("plant_models", "synth", "tuning_tables"):
        shutil.copytree(ROOT / package, tmp_path / package, ignore=shutil.ignore_patterns("__pycache__"))
    elsewhere = [str(tmp_path), *(path for path in sys.path if path.endswith("site-packages"))]
    program = f"import sys; sys.path += {elsewhere!r}; from synth.cli import main; raise SystemExit(main(['study']))"
    run = subprocess.run(
        [sys.executable, "-S", "-P", "-c", program],
        cwd=tmp_path, env={}, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert (run.returncode, run.stdout, run.stderr.count("\n")) == (2, "", 1)
    assert "studies come with a checkout of the source" in run.stderr


def test_a_study_that_lacks_a_library_is_not_taken_for_a_missing_checkout(monkeypatch: pytest.MonkeyPatch) -> None:
    def lacking(name: str) -> None:
        raise ModuleNotFoundError("No module named 'matplotlib'", name="matplotlib")

    monkeypatch.setattr("synth.cli.study.import_module", lacking)
    with pytest.raises(ModuleNotFoundError, match="matplotlib"):
        laboratory()
