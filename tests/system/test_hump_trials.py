"""`hump simulate` and `hump speed` from the command line to the last file."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from synth.cli import main
from tests.frame.small_command import results_in
from tests.system.conftest import EPOCH, Command, changed

SMALL = """\
hump = "medium"
[trains]
number = 12
cuts = 6
most_cars = 3
[exit_speeds]
choices = 4
[aim]
design_cuts = 200
[acceptance]
catch_ups = 1.0
overspeed = 1.0
"""


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A configuration of twelve short trains."""
    path = tmp_path_factory.mktemp("trains") / "small.toml"
    path.write_text(SMALL, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def humped(small: Path) -> Path:
    """The directory of these trains; not to be changed."""
    directory = small.with_name("out")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", EPOCH)
        assert main(["hump", "simulate", str(small), "-o", str(directory)]) == 0
    return directory


def summary_of(directory: Path) -> dict[str, Any]:
    """The summary in `directory`."""
    found: dict[str, Any] = json.loads((directory / "summary.json").read_bytes())
    return found


def figures_of(summary: dict[str, Any]) -> dict[str, Any]:
    """The figures of all trains by name: each an interval, or a number where the trains are too few for one."""
    tables = summary["tables"]
    return {row["name"]: row[key] for name, key in (("shares", "share"), ("means", "mean")) for row in tables[name]}


def value_of(figure: Any) -> Any:
    """A figure without its interval."""
    return figure["value"] if isinstance(figure, dict) else figure


def arrays_of(directory: Path) -> Mapping[str, Any]:
    """The arrays by train, read with numpy alone."""
    with np.load(directory / "trains.npz", allow_pickle=False) as arrays:
        return dict(arrays)


def test_every_file_is_whole_and_listed(humped: Path) -> None:
    summary = summary_of(humped)
    files = set(results_in(humped))
    batches = {name for name in files if name.startswith("batches/")}
    assert len(batches) == 1
    assert files - batches - {"summary.json"} == set(summary["files"])
    assert {
        "trains.npz",
        "sheets/shares.csv",
        "sheets/means.csv",
        "sheets/elements.csv",
        "sheets/positions.csv",
        "sheets/program.csv",
        "events.csv",
        "report.html",
        "hump.html",
    } <= files
    page = (humped / "report.html").read_text(encoding="utf-8")
    assert page.endswith("</html>\n")
    assert 'href="hump.html"' in page
    assert 'href="events.csv"' in page
    assert summary["generator"]["config_sha256"] in page


def test_the_figures_follow_from_the_arrays_by_train(humped: Path) -> None:
    """Ratios of sums over trains, worked out anew with numpy alone."""
    summary, arrays = summary_of(humped), arrays_of(humped)
    assert summary["figures"]["trains"] == 12
    assert summary["figures"]["cuts"] == 72 == arrays["cuts"].sum()
    told = {name: value_of(figure) for name, figure in figures_of(summary).items()}
    assert told["hump_speed"] == pytest.approx(arrays["span_m"].sum() / arrays["span_s"].sum(), rel=1e-12)
    assert told["cars_per_hour"] == pytest.approx(3600.0 * arrays["span_cars"].sum() / arrays["span_s"].sum())
    assert told["catch_ups"] == pytest.approx(arrays["caught"].sum() / 72)
    assert told["gap_per_cut"] == pytest.approx(arrays["gap_m"].sum() / arrays["judged"].sum())
    for name, figure in figures_of(summary).items():
        assert figure["low95"] <= figure["value"] <= figure["high95"], name
        assert figure["n"] in (12, 72, arrays["judged"].sum()), name
    sheets: dict[str, float] = {}
    for sheet, key in (("shares", "share"), ("means", "mean")):
        rows = csv.DictReader(io.StringIO((humped / "sheets" / f"{sheet}.csv").read_text(encoding="utf-8")))
        sheets |= {row["name"]: float(row[key]) for row in rows}
    assert sheets == told
    errors = [position["rms_of_exit_less_command_m_s"] for position in summary["tables"]["positions"]]
    squares = arrays["error2_m2_s2"].sum(axis=0) / arrays["passes"].sum(axis=0)
    assert [error["value"] for error in errors] == pytest.approx(np.sqrt(squares))
    assert errors[1]["value"] == pytest.approx(0.15, abs=0.06)  # 72 errors of 0.15, four standard deviations of theirs
    assert errors[1]["low95"] < 0.15 < errors[1]["high95"]


def test_one_hump_speed_is_what_is_told(command: Command, small: Path, tmp_path: Path) -> None:
    """With one speed for all cuts the mean is that speed, in every train."""
    config = tmp_path / "even.toml"
    text = changed(SMALL, ("[exit_speeds]", "[hump_speed]\nconstant_m_s = 1.5\n[exit_speeds]"))
    config.write_text(text + "[output]\nplots = false\nreport = false\n", encoding="utf-8")
    assert command("hump", "simulate", config, "-o", tmp_path / "out").code == 0
    figure = figures_of(summary_of(tmp_path / "out"))["hump_speed"]
    np.testing.assert_allclose([figure[key] for key in ("value", "low95", "high95")], 1.5, rtol=1e-12)
    names = {name.partition("/")[0] for name in results_in(tmp_path / "out")}
    assert names.isdisjoint({"report.html", "hump.html"})
    assert not (tmp_path / "out" / "plots").exists()


def test_a_missed_limit_is_code_1_and_says_which(command: Command, tmp_path: Path) -> None:
    """Twelve trains cannot show that fewer than 1 cut in 1000 is caught up."""
    for limit, code, word in (("0.001", 1, "; these trains are too few to tell"), ("0.9", 0, "")):
        config = tmp_path / "limit.toml"
        text = changed(SMALL, ("catch_ups = 1.0", f"catch_ups = {limit}"))
        config.write_text(text + "[output]\nplots = false\nreport = false\n", encoding="utf-8")
        ran = command("hump", "simulate", config, "-o", tmp_path / "out", "--json")
        assert ran.code == code
        told = json.loads(ran.out)
        assert told == summary_of(tmp_path / "out")
        (told_limit,) = told["limits"]
        assert told_limit["sentence"].endswith(f"at most {100.0 * float(limit):g} % allowed{word}")
        assert told_limit["kept"] is (True if code == 0 else None)
        assert told["accepted"] is (code == 0)


LIST = """\
cut,cars,axles,mass_t,category,track,length_m,marks
1,1,4,23,L,3,13.92,
2,2,8,160,T,11,27.84,
3,1,4,60,S,4,13.92,do-not-hump
4,1,4,85,T,5,13.92,
"""


@pytest.mark.long
def test_a_sorting_list_is_every_train(command: Command, small: Path, tmp_path: Path) -> None:
    (tmp_path / "train.csv").write_text(LIST, encoding="utf-8")
    ran = command("hump", "speed", small, "--list", tmp_path / "train.csv", "-o", tmp_path / "speed", "--json")
    assert ran.code == 0
    told = json.loads(ran.out)
    assert [(row["cars"], row["track"], row["category"]) for row in told["tables"]["program"]] == [
        (1, 3, "L"), (2, 11, "T"), (1, 5, "T"),
    ]  # fmt: skip
    assert all((tmp_path / "speed" / file).is_file() for file in told["files"])
    out = tmp_path / "out"
    assert command("hump", "simulate", small, "--list", tmp_path / "train.csv", "-o", out, "--trains", 3).code == 0
    assert arrays_of(out)["cars"].tolist() == [4, 4, 4]
    (tmp_path / "train.csv").unlink()
    again = command("hump", "simulate", out / "inputs" / "config.toml", "-o", out)
    assert again.code == 0  # the list is among the inputs
    assert "1 of 1 batches are there already" in again.err


def test_the_sheet_is_that_of_the_program(command: Command, small: Path, humped: Path, tmp_path: Path) -> None:
    number = summary_of(humped)["figures"]["train"]
    ran = command("hump", "speed", small, "-o", tmp_path, "--train", number)
    assert ran.code == 0
    assert f"train {number}: cuts: 6; over the crest in " in ran.out
    sheet = tmp_path / "sheets" / "program.csv"
    first = sheet.read_bytes()
    assert first == (humped / "sheets" / "program.csv").read_bytes()
    summary = summary_of(tmp_path)
    assert f"{summary['figures']['planned_cars_per_hour']:.0f} cars an hour" in ran.out
    other = command("hump", "speed", small, "-o", tmp_path, "--train", number % 12 + 1)
    assert other.code == 0
    assert sheet.read_bytes() != first
    assert summary_of(tmp_path)["generator"] != summary["generator"]


def test_the_template_of_init_is_read_by_simulate(command: Command, tmp_path: Path) -> None:
    printed = command("init", "trial")
    assert printed.code == 0
    config = tmp_path / "mine.toml"
    config.write_text(changed(printed.out, ("cuts = 40", "cuts = 3")), encoding="utf-8")
    assert command("hump", "speed", config, "-o", tmp_path / "out").code == 0
    assert command("init", "hump", "dumper").out.splitlines()[1].startswith("# Yard of a car dumper")
    assert "the library has no such hump; did you mean large?" in command("init", "hump", "larg").sentence


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["simulate", "nope"], "nope: there is no such file, and no such hump in the library"),
        (["simulate", "nope.toml"], "there is no such file; write one with 'retarder-synth init trial -o nope.toml'"),
        (["simulate", "--workers", "2", "--scheduler", "x"], "--workers and --scheduler are both given"),
        (["simulate", "--trains", "0"], "--trains is '0'; it must be a whole number from 1 to 10000000"),
        (["simulate", "--list", "none.csv"], "none.csv: there is no such file; give the path of a sorting list"),
        (["speed", "--train", "0"], "--train is '0'; it must be a whole number from 1 to 10000000"),
    ],
)
def test_bad_input_is_one_sentence(
    command: Command, arguments: list[str], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    ran = command("hump", *arguments)
    assert ran.code == 2
    assert said in ran.sentence
    assert list(tmp_path.iterdir()) == []
