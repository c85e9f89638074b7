"""`hump simulate`, `hump speed` and `hump report` from the command line to the last file."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from synth.cli import main
from synth.present.report.figure_table import TITLES
from tests.frame.results import results_in
from tests.printed_page import Page, page_about, table_of
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


def arrays_of(directory: Path) -> Mapping[str, Any]:
    """The arrays by train, read with numpy alone."""
    with np.load(directory / "trains.npz", allow_pickle=False) as arrays:
        return dict(arrays)


def test_it_prints_the_figures_of_its_summary(humped: Path, pages: list[Page]) -> None:
    summary, page = summary_of(humped), page_about(pages, humped)
    assert f"trains: {summary['trains']}; cuts: {summary['cuts']}; cars: {summary['cars']}" in str(page[0])
    figures = {TITLES.get(name, name.replace("_", " ")): figure for name, figure in summary["figures"].items()}
    told = {row["figure"].removesuffix(", %").removesuffix(", m/s").removesuffix(", m"): row for row in table_of(page)}
    assert told.keys() == figures.keys()
    for title, row in told.items():
        figure = figures[title]
        scale = 100.0 if row["figure"].endswith(", %") else 1.0
        ends = figure["ci95"]
        found = [float(word.strip("[],")) for word in f"{row['value']} {row['95 %']}".split() if word != "–"]
        wanted = [scale * each for each in (figure["value"], *([] if None in ends else ends)) if each is not None]
        assert found == pytest.approx(wanted, rel=0.006)


def test_every_file_is_whole_and_listed(humped: Path) -> None:
    summary = summary_of(humped)
    files = set(results_in(humped))
    batches = {name for name in files if name.startswith("batches/")}
    assert len(batches) == 1
    assert files - batches - {"summary.json"} == set(summary["files"])
    for name, digest in summary["files"].items():
        assert hashlib.sha256((humped / name).read_bytes()).hexdigest() == digest, name
    assert {
        "trains.npz",
        "figures.csv",
        "locomotive.csv",
        "uncoupler.csv",
        "events.csv",
        "report.html",
        "hump.html",
    } <= files
    for plot in (humped / "plots").iterdir():
        if plot.suffix == ".svg":
            ElementTree.fromstring(plot.read_bytes())
    page = (humped / "report.html").read_text(encoding="utf-8")
    assert page.endswith("</html>\n")
    assert 'href="hump.html"' in page
    assert 'href="events.csv"' in page
    assert summary["generator"]["config_sha256"] in page


def test_the_figures_follow_from_the_arrays_by_train(humped: Path) -> None:
    """Ratios of sums over trains, worked out anew with numpy alone."""
    summary, arrays = summary_of(humped), arrays_of(humped)
    assert summary["trains"] == 12
    assert summary["cuts"] == 72 == arrays["cuts"].sum()
    told = {name: figure["value"] for name, figure in summary["figures"].items()}
    assert told["hump_speed"] == pytest.approx(arrays["span_m"].sum() / arrays["span_s"].sum(), rel=1e-12)
    assert told["cars_per_hour"] == pytest.approx(3600.0 * arrays["span_cars"].sum() / arrays["span_s"].sum())
    assert told["catch_ups"] == pytest.approx(arrays["caught"].sum() / 72)
    assert told["gap_per_cut"] == pytest.approx(arrays["gap_m"].sum() / arrays["judged"].sum())
    for name, figure in summary["figures"].items():
        if figure["ci95"][0] is not None:
            assert figure["ci95"][0] <= figure["value"] <= figure["ci95"][1], name
    rows = list(csv.DictReader(io.StringIO((humped / "figures.csv").read_text(encoding="utf-8"))))
    assert {row["figure"]: float(row["value"]) for row in rows} == told
    errors = [position["rms_of_exit_less_command_m_s"] for position in summary["positions"]]
    assert errors[1] == pytest.approx(0.15, abs=0.06)  # 72 errors of 0.15, four standard deviations of their rms


def test_one_hump_speed_is_what_is_told(command: Command, small: Path, tmp_path: Path) -> None:
    """With one speed for all cuts the mean is that speed, in every train."""
    config = tmp_path / "even.toml"
    text = changed(SMALL, ("[exit_speeds]", "[hump_speed]\nconstant_m_s = 1.5\n[exit_speeds]"))
    config.write_text(text + "[output]\nplots = false\nreport = false\n", encoding="utf-8")
    assert command("hump", "simulate", config, "-o", tmp_path / "out").code == 0
    figure = summary_of(tmp_path / "out")["figures"]["hump_speed"]
    np.testing.assert_allclose([figure["value"], *figure["ci95"]], 1.5, rtol=1e-12)
    names = {name.partition("/")[0] for name in results_in(tmp_path / "out")}
    assert names.isdisjoint({"report.html", "hump.html"})
    assert not (tmp_path / "out" / "plots").exists()


def test_stale_pages_and_pictures_go(command: Command, humped: Path, tmp_path: Path) -> None:
    out = Path(shutil.copytree(humped, tmp_path / "out"))
    (out / "plots" / "mine.png").write_bytes(b"x")
    config = tmp_path / "plain.toml"
    config.write_text(SMALL + "[output]\nplots = false\nreport = false\n", encoding="utf-8")
    assert command("hump", "simulate", config, "-o", out).code == 0
    assert [path.name for path in (out / "plots").iterdir()] == ["mine.png"]
    assert not (out / "report.html").exists()
    assert not (out / "hump.html").exists()


def test_report_repeats_every_byte_elsewhere(command: Command, humped: Path, tmp_path: Path) -> None:
    out = Path(shutil.copytree(humped, tmp_path / "elsewhere"))
    for path in [*(out / "plots").iterdir(), out / "report.html", out / "hump.html", out / "summary.json"]:
        path.unlink()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", EPOCH)
        assert command("hump", "report", out).code == 0
    for path in humped.rglob("*"):
        if path.is_file():
            assert (out / path.relative_to(humped)).read_bytes() == path.read_bytes(), path


def test_a_missed_limit_is_code_1_and_says_which(command: Command, tmp_path: Path) -> None:
    """Twelve trains cannot show that fewer than 1 cut in 1000 is caught up."""
    for limit, code, word in (("0.001", 1, "cannot be told from"), ("0.9", 0, "keeps")):
        config = tmp_path / "limit.toml"
        text = changed(SMALL, ("catch_ups = 1.0", f"catch_ups = {limit}"))
        config.write_text(text + "[output]\nplots = false\nreport = false\n", encoding="utf-8")
        ran = command("hump", "simulate", config, "-o", tmp_path / "out", "--json")
        assert ran.code == code
        told = json.loads(ran.out)
        assert told == summary_of(tmp_path / "out")
        assert f"{word} the limit {limit}" in told["verdict"]
        assert told["accepted"] is (code == 0)


LIST = """\
cut,cars,axles,mass_t,category,track,length_m,marks
1,1,4,23,L,3,13.92,
2,2,8,160,T,11,27.84,
3,1,4,60,S,4,13.92,do-not-hump
4,1,4,85,T,5,13.92,
"""


def test_a_sorting_list_is_every_train(command: Command, small: Path, tmp_path: Path) -> None:
    (tmp_path / "train.csv").write_text(LIST, encoding="utf-8")
    ran = command("hump", "speed", small, "--list", tmp_path / "train.csv", "-o", tmp_path / "speed", "--json")
    assert ran.code == 0
    told = json.loads(ran.out)
    assert [(row["cars"], row["track"], row["category"]) for row in told["cuts"]] == [
        (1, 3, "L"), (2, 11, "T"), (1, 5, "T"),
    ]  # fmt: skip
    assert all(Path(file).is_file() for file in told["files"])
    out = tmp_path / "out"
    assert command("hump", "simulate", small, "--list", tmp_path / "train.csv", "-o", out, "--trains", 3).code == 0
    assert arrays_of(out)["cars"].tolist() == [4, 4, 4]
    (tmp_path / "train.csv").unlink()
    assert command("hump", "report", out).code == 0  # the list is among the inputs


def test_the_sheet_is_that_of_the_program(command: Command, small: Path, humped: Path, tmp_path: Path) -> None:
    ran = command("hump", "speed", small, "-o", tmp_path)
    assert ran.code == 0
    assert "train 1: cuts: 6; over the crest in " in ran.out
    for name in ("locomotive", "uncoupler"):
        assert (tmp_path / f"train-1-{name}.csv").read_bytes() == (humped / f"{name}.csv").read_bytes()
    other = command("hump", "speed", small, "-o", tmp_path, "--train", 2)
    assert other.code == 0
    assert (tmp_path / "train-2-uncoupler.csv").read_bytes() != (tmp_path / "train-1-uncoupler.csv").read_bytes()


def test_the_template_of_init_is_read_by_simulate(command: Command, tmp_path: Path) -> None:
    printed = command("init", "--hump")
    assert printed.code == 0
    config = tmp_path / "mine.toml"
    config.write_text(changed(printed.out, ("cuts = 40", "cuts = 3")), encoding="utf-8")
    assert command("hump", "speed", config, "-o", tmp_path / "out").code == 0
    assert command("init", "--hump", "dumper").out.startswith("# Yard of a car dumper")
    assert "the library has no such hump; did you mean large?" in command("init", "--hump", "larg").sentence
    assert command("init", "--hump", "--aim").sentence == "init prints one file at a time; give one of its options"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["simulate", "nope"], "nope: there is no such file, and no such hump in the library"),
        (["simulate", "nope.toml"], "there is no such file; write one with 'retarder-synth init --hump > nope.toml'"),
        (["simulate", "--workers", "2", "--scheduler", "x"], "--workers and --scheduler are both given"),
        (["simulate", "--trains", "0"], "Invalid value for '--trains': it is '0'; give a whole number from 1"),
        (["simulate", "--list", "none.csv"], "none.csv: there is no such file; give the path of a sorting list"),
        (["report", "."], "there is no inputs/config.toml in it; give what 'hump simulate' left"),
        (["speed", "--train", "0"], "Invalid value for '--train': it is '0'"),
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


def test_what_another_command_has_left_is_not_written_over(command: Command, humped: Path, tmp_path: Path) -> None:
    assert "it holds the results of 'hump simulate'" in command("aim", "-o", humped).sentence
