"""A tune with the estimator: tables that do better, are read, validated and shown like any other."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from synth.cli import main
from synth.retarder.configuration.config_file import load_config
from tests.system.conftest import CLASS, EPOCH, Command
from tuning_tables import TableBook, read_book, read_json, write_book

Tuned = tuple[Path, Path, int]
CONFIG = (
    CLASS.replace("csv = true", "plots = false").replace("passes = 1000", "passes = 4000")
    + "[regulator]\nestimator = true\n"
)


@pytest.fixture(scope="module")
def tuned(tmp_path_factory: pytest.TempPathFactory) -> Tuned:
    """(configuration, output directory, exit code)."""
    config = tmp_path_factory.mktemp("estimator") / "estimator.toml"
    config.write_text(CONFIG)
    out = config.with_suffix("")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", EPOCH)
        return config, out, main(["tune", str(config), "-o", str(out), "--workers", "2"])


@pytest.fixture
def case(tuned: Tuned) -> Any:
    """The first case of the summary."""
    return first_of(tuned[1], "cases")


def first_of(directory: Path, table: str) -> Any:
    """The only row of a table of the summary."""
    (row,) = json.loads((directory / "summary.json").read_text())["tables"][table]
    return row


def file_of(case: Any) -> str:
    """Where the table of the case is."""
    return f"tables/{case['id']}.json"


def test_its_tables_say_that_they_are_for_it_and_where_the_prediction_comes_from(tuned: Tuned, case: Any) -> None:
    assert tuned[2] == 0
    written = json.loads((tuned[1] / file_of(case)).read_text())
    assert (written["version"], written["kind"]) == (1, "lines")
    assert written["predicted"]["passes"] >= 1000
    table = read_json(tuned[1] / file_of(case))
    assert table.estimator is not None
    assert table.estimator.s_m[-1] == pytest.approx(table.retarder.exit_m)
    assert read_book(tuned[1] / "book.h5")[0] == table


def test_its_figures_are_honest_and_their_origin_is_told(tuned: Tuned, case: Any) -> None:
    assert 0.8 < case["prediction_ratio"]["value"] < 1.25
    design = first_of(tuned[1], "designs")
    assert 0.01 < design["error_m_s"] < 0.035  # of 0.05 measured
    assert design["tuning_rms_m_s"] <= design["tuning_rms_before_trim_m_s"]
    assert "it tests the sample, not the model" in (tuned[1] / "report.html").read_text()


def test_the_estimator_is_the_default_and_does_better_than_none(
    command: Command, tuned: Tuned, case: Any, tmp_path: Path
) -> None:
    config = tmp_path / "without.toml"
    config.write_text(CONFIG.replace("estimator = true", "estimator = false"))
    assert command("tune", config, "-o", tmp_path / "out", "--workers", "1").code in (0, 1)
    without = first_of(tmp_path / "out", "cases")
    assert first_of(tmp_path / "out", "designs")["error_m_s"] is None
    assert read_json(tmp_path / "out" / file_of(without)).estimator is None
    assert case["rms_m_s"]["high95"] < without["rms_m_s"]["low95"]
    assert "two independent computations of one quantity" in (tmp_path / "out" / "report.html").read_text()
    assert load_config(None).regulator.estimator


def test_validate_runs_the_estimator_of_the_file(command: Command, tuned: Tuned, case: Any, tmp_path: Path) -> None:
    """On fresh passes it is as good as the tune found it."""
    asked = ("validate", tuned[1] / file_of(case), "--config", tuned[0], "--passes", "4000", "--seed", "5")
    assert command(*asked, "-o", tmp_path).code in (0, 1)
    found = first_of(tmp_path, "tables")["rms_m_s"]["value"]
    assert 0.8 * case["rms_m_s"]["low95"] < found < 1.25 * case["rms_m_s"]["high95"]


def test_inspect_tells_which_tables_of_a_book_have_an_estimator(command: Command, tuned: Tuned, tmp_path: Path) -> None:
    estimating = read_book(tuned[1] / "book.h5")[0]
    none = replace(
        estimating,
        id="none",
        target_speed_m_s=9.0,
        estimator=None,
        predicted=replace(estimating.predicted, passes=None),
    )
    write_book(TableBook((estimating, none)).tables, tmp_path / "mixed.h5")
    told = command("inspect", tmp_path / "mixed.h5").out
    assert "a book of 2 tables, 1 with an estimator and 1 without" in told
    assert "estimator  none: the lines are for the measured speed" in told.split("none: leave with")[1]
    assert "none: the lines are" not in command("inspect", tuned[1] / "book.h5").out


def test_what_cannot_be_had_together_is_said(command: Command, tmp_path: Path) -> None:
    config = tmp_path / "both.toml"
    config.write_text(CONFIG + "[criterion]\np_overspeed = 0.01\n")
    run = command("tune", config, "-o", tmp_path / "out")
    assert run.code == 2
    assert "regulator.estimator is true" in run.err
    assert "set that" in run.err
    assert not (tmp_path / "out").exists()
