"""A book for commands at any time as a user makes it: tuned, told, checked, exported, simulated again; faults."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from synth.cli import main
from synth.frame.terminal.printed_page import PrintedTable
from synth.retarder.configuration.config_file import load_config
from synth.retarder.sweep.tune_unit import between_rms_m_s
from synth.solver.chain.chain import check_chain
from tests.printed_page import Page, cells_of
from tuning_tables import ControllerTable, Decisions, read_book

BOOK = """\
[position]
name = "rnz-2m-park"
[targets]
exit_speeds_m_s = [2.0, 2.5]
[grid]
path_step_m = 0.5
[regulator]
commands = "any_time"
pressure = "{pressure}"
estimator = {estimator}
[validation]
passes = 4000
[output]
csv = true
plots = false
[[cut]]
car = "gondola-4"
mass_t = 22
"""

ASKED = '[regulator]\ncommands = "any_time"\n'


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Books with a gauge, tuned by one thread and for the measured speed, and one without a gauge."""
    place = tmp_path_factory.mktemp("any-time")
    tune(place, "one", BOOK.format(pressure="gauge", estimator="true"), 1)
    tune(place, "none", BOOK.format(pressure="none", estimator="true").replace("[2.0, 2.5]", "[2.5]"), 2)
    tune(place, "measured", BOOK.format(pressure="gauge", estimator="false"), 2)
    return place


def tune(folder: Path, name: str, config: str, workers: int) -> None:
    """Leave in `folder` the configuration `name`.toml and what a tune of it makes, called `name`."""
    file = folder / f"{name}.toml"
    file.write_text(config, encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", "1700000000")
        assert main(["tune", str(file), "-o", str(folder / name), "--workers", str(workers)]) in (0, 1)


@pytest.fixture(scope="module")
def tables(folder: Path) -> tuple[ControllerTable, ...]:
    return read_book(folder / "one" / "book.h5")


def summary(folder: Path) -> dict[str, Any]:
    """summary.json."""
    read: dict[str, Any] = json.loads((folder / "summary.json").read_bytes())
    return read


def test_tables_decide_at_any_time_and_their_prediction_is_true(
    folder: Path, tables: tuple[ControllerTable, ...]
) -> None:
    assert {(table.decisions, table.has_gauge) for table in tables} == {(Decisions.AT_ANY_TIME, True)}
    bare = read_book(folder / "none" / "book.h5")
    assert {(table.decisions, table.has_gauge) for table in bare} == {(Decisions.AT_ANY_TIME, False)}
    for table in (*tables, *bare):
        assert table.validated is not None
        low, high = table.validated.rms_ci95_m_s
        assert 0.95 * low < table.predicted.rms_m_s < 1.05 * high


@pytest.mark.parametrize("name", ["one", "measured"])
def test_they_are_better_than_the_lines_of_the_same_tune_at_rest(folder: Path, name: str) -> None:
    """With the estimator little is left to gain, in one case no more than 4000 passes can tell."""
    tables = summary(folder / name)["tables"]
    cases = tables["cases"]
    rows = {(row["label"], row["target_speed_m_s"], row["controller"]): row for row in tables["controllers"]}
    assert sum(case["at_rest_ratio"]["high95"] < 1.0 for case in cases) >= (1 if name == "one" else 2)
    for case in cases:
        key = case["label"], case["target_speed_m_s"]
        at_rest, best = (rows[*key, controller] for controller in ("commands at rest", case["best_baseline"]))
        assert case["at_rest_ratio"]["value"] < 1.0
        assert case["at_rest_ratio"]["value"] == pytest.approx(case["rms_m_s"]["value"] / at_rest["rms_m_s"]["value"])
        assert best["table_ratio"]["high95"] < 1.0


@pytest.mark.parametrize("name", ["one", "none"])
def test_the_independent_checker_confirms_them(folder: Path, name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", str(folder / name)]) == 0
    assert "nothing found" in capsys.readouterr().out


def test_inspect_tells_when_they_decide_and_how_lines_rise(
    folder: Path, capsys: pytest.CaptureFixture[str], pages: list[Page]
) -> None:
    assert main(["inspect", str(folder / "one" / "book.h5")]) == 0
    told = capsys.readouterr().out
    assert "at every sample, also while the pressure is on its way; with the pressure of a gauge" in told
    tables = [each for each in pages[-1] if isinstance(each, PrintedTable)]
    for table, printed in zip(read_book(folder / "one" / "book.h5"), tables, strict=True):
        slopes = [slope for stage in table.stages for slope in stage.slopes if slope is not None]
        told_slopes = [row["+ m/s per 100 kPa"] for row in cells_of(printed)]
        assert told_slopes == [f"{100.0 * slope:+.4f}" for slope in slopes[: len(told_slopes)]]
        assert told_slopes
    assert main(["inspect", str(folder / "none" / "book.h5")]) == 0
    assert "without a pressure gauge" in capsys.readouterr().out


def test_they_are_drawn_and_simulated_again_from_the_file(folder: Path) -> None:
    table = next((folder / "one" / "tables").glob("*.json"))
    assert main(["inspect", str(table), "-o", str(folder / "plots")]) == 0
    assert {path.name.rpartition("-")[2] for path in (folder / "plots").iterdir()} >= {"surfaces.svg", "lines.svg"}
    asked = [
        "validate",
        str(table),
        "--config",
        str(folder / "one.toml"),
        "--passes",
        "4000",
        "-o",
        str(folder / "again"),
    ]
    assert main(asked) in (0, 1)
    (found,) = summary(folder / "again")["tables"]["tables"]
    document = json.loads(table.read_bytes())
    assert found["rms_m_s"]["value"] == document["validated"]["rms_m_s"]


def test_lines_between_two_tables_are_predicted_with_their_slopes(folder: Path) -> None:
    """Only those for the measured speed: no sweep asks it of others."""
    config = load_config(folder / "measured.toml")
    ((_, plant),) = config.plants()
    slower, faster = read_book(folder / "measured" / "book.h5")
    near = float(np.nextafter(np.float32(2.0), np.float32(3.0)))
    check = check_chain(plant, config.resolution)
    assert between_rms_m_s(check, slower, faster, near) == pytest.approx(slower.predicted.rms_m_s, rel=1e-3)
    between = between_rms_m_s(check, slower, faster, 2.25)
    assert between < 1.1 * max(slower.predicted.rms_m_s, faster.predicted.rms_m_s)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ('[regulator]\ncommands = "always"\n', "regulator.commands is 'always'; it must be 'at_rest' or 'any_time'"),
        ('[regulator]\npressure = "some"\n', "regulator.pressure is 'some'"),
        (ASKED + "estimator = false\n[criterion]\np_overspeed = 0.1\n", 'regulator.commands is "any_time", but'),
        (ASKED + "[retarder.pneumatics]\nclosing_delay_s = 0.05\n", "closing_delay_s is 0.05"),
        (ASKED + "[sensor]\ncomputing_delay_s = 0.5\n", "computing_delay_s is 0.5"),
        (ASKED + "[sensor]\nnoise_m_s = 0.0\nresolution_m_s = 0.0\n", "noise_m_s is 0"),
    ],
)  # fmt: skip
def test_what_is_not_modelled_is_refused_in_one_sentence(
    text: str, sentence: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "bad.toml"
    file.write_text(text, encoding="utf-8")
    assert main(["tune", str(file), "-o", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err
    assert sentence in told
    assert "Traceback" not in told
    assert not (tmp_path / "out").exists()


def test_a_plant_on_which_it_cannot_be_simulated_is_refused(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    slow = folder / "slow.toml"
    cut = '[[cut]]\ncar = "gondola-4"\nmass_t = 22\n'
    slow.write_text(f"{BOOK.split('[regulator]')[0]}[sensor]\ncomputing_delay_s = 0.5\n{cut}", encoding="utf-8")
    table = next((folder / "one" / "tables").glob("*.json"))
    assert main(["validate", str(table), "--config", str(slow), "--passes", "2000", "-o", str(folder / "not")]) == 2
    assert "computing_delay_s is 0.5" in capsys.readouterr().err


def test_a_loop_of_python_control_is_refused(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = next((folder / "one" / "tables").glob("*.json"))
    asked = ["loop", str(table), "--config", str(folder / "one.toml"), "-o", str(folder / "loop")]
    assert main(asked) == 2
    assert "the table decides at any time" in capsys.readouterr().err
