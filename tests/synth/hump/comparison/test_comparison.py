"""Runs side by side: figures of each as it told them itself, differences as Student's test has them."""

from __future__ import annotations

import json
import re
from pathlib import Path
from shutil import copytree

import numpy as np
import pytest
from scipy.stats import ttest_rel

from synth.cli import main
from synth.frame.exhibits import File, Sentence
from synth.hump.compare_command import as_told, humped_again, played
from synth.hump.compared_runs import compared_trains, runs_in

TRIAL = """hump = "dumper"
[trains]
number = {trains}
cuts = 12
most_cars = 1
category_shares = {{ L = 1 }}
[aim]
design_cuts = 200
[hump_speed]
constant_m_s = {speed}
[output]
plots = false
report = false
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two runs, one of more trains."""
    found = tmp_path_factory.mktemp("compared")
    for name, trains, speed in (("slow", 14, 2.0), ("fast", 12, 3.2)):
        (found / f"{name}.toml").write_text(TRIAL.format(trains=trains, speed=speed), encoding="utf-8")
        main(["hump", "simulate", str(found / f"{name}.toml"), "-o", str(found / name)])
    return found


def test_figures_are_those_of_the_runs_and_differences_those_of_student(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["hump", "compare", str(folder / "slow"), str(folder / "fast"), "-o", str(folder / "out")]) == 0
    assert "2 runs of the same 12 trains, 144 cuts" in capsys.readouterr().out
    tables = json.loads((folder / "out" / "summary.json").read_bytes())["tables"]
    slow, fast = runs_in([folder / "slow", folder / "fast"])
    assert len(slow.found) == len(fast.found) == 12
    rows = {(row["name"], row["run"]): row for row in (*tables["means"], *tables["shares"])}
    told = json.loads((folder / "fast" / "summary.json").read_bytes())["tables"]["means"]
    (own,) = (row for row in told if row["name"] == "cars_per_hour")
    assert rows["cars_per_hour", "fast"]["value"] == own["mean"]
    # All trains have as many cuts, so the difference of shares is a mean of paired differences.
    caught = [run.found.caught / run.found.cuts for run in (fast, slow)]
    assert (caught[0] + caught[1]).sum() * 12 >= 10
    expected = ttest_rel(caught[0], caught[1]).confidence_interval(0.95)
    found = rows["catch_ups", "fast"]["difference"]
    assert found["value"] == pytest.approx((caught[0] - caught[1]).mean())
    assert (found["low95"], found["high95"]) == pytest.approx((expected.low, expected.high))
    assert rows["catch_ups", "slow"]["difference"] is None
    assert np.isfinite(rows["cars_per_hour", "fast"]["difference"]["low95"])


def test_a_page_plays_the_train_with_the_largest_difference_in_both_runs(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    slow, _ = runs = runs_in([folder / "slow", folder / "fast"])
    page, told = played(runs)
    assert isinstance(page, File)
    assert isinstance(told, Sentence)
    (text,) = re.findall(r'<script id="data" type="application/json">(.*?)</script>', page.content.decode(), re.DOTALL)
    data = json.loads(text)
    title = r"train (\d+): largest difference in catch-ups, (\d+) in slow, (\d+) in fast"
    found = re.match(title, data["trains"][0])
    assert found
    number, *counts = map(int, found.groups())
    caught = np.stack([run.found.caught for run in runs])
    assert counts == list(caught[:, number - 1])
    assert abs(counts[1] - counts[0]) == np.abs(caught[1] - caught[0]).max() > 1
    assert told.figures["played"][0] == number
    for run, name, count in zip(data["runs"], ("slow", "fast"), counts, strict=True):
        cuts = run["trains"][0]["cuts"]
        assert (run["name"], len(cuts), sum(cut["caught_s"] is not None for cut in cuts)) == (name, 12, count)

    of_slow = humped_again(slow, compared_trains(runs)[:1])
    assert as_told(of_slow[0], slow.found)
    monkeypatch.setattr("synth.hump.compare_command.humped_again", lambda run, chosen: of_slow)
    (warning,) = played(runs)
    assert isinstance(warning, Sentence)
    assert warning.text.startswith("Warning: fast was humped by another version of this program")


def test_what_cannot_be_compared_is_refused(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = TRIAL.format(trains=12, speed=2.0).replace("cuts = 12", "cuts = 11")
    (tmp_path / "other.toml").write_text(text, encoding="utf-8")
    main(["hump", "simulate", str(tmp_path / "other.toml"), "-o", str(tmp_path / "other")])
    copytree(folder / "fast", tmp_path / "half")
    (tmp_path / "half" / "summary.json").unlink()
    for others, said in (
        ((str(tmp_path / "other"),), "other humped other trains than slow: train 1 has 11 cuts, not 12"),
        ((str(tmp_path / "half"),), "there is no summary.json; give a directory in which 'hump simulate' has come"),
        ((str(tmp_path / "none"),), "there is no inputs/config.toml"),
        ((str(folder / "slow"),), "is given twice"),
    ):
        capsys.readouterr()
        assert main(["hump", "compare", str(folder / "slow"), *others, "-o", str(tmp_path / "out")]) == 2
        assert said in " ".join(capsys.readouterr().err.split())
        assert not (tmp_path / "out").exists()
