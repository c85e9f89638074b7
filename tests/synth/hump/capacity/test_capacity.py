"""The command: its points are the trials that a user would write, and its figures those of their trains."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from synth.cli import main
from synth.hump.capacity.crossings import Sums
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.trains.made_trial import made_trial
from synth.hump.trains.resolved_trial import resolve_trial

TRIAL = """hump = "dumper"
[trains]
number = 12
cuts = 12
most_cars = 1
category_shares = { L = 1 }
[aim]
design_cuts = 200
[output]
plots = false
"""
WORDS = ("--exit-std", "0.5,0.05", "--speeds", "2.5,3.2", "--catch-ups", "0.1", "--workers", "1")


@pytest.fixture(scope="module")
def humped(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two curves of two points."""
    folder = tmp_path_factory.mktemp("capacity")
    (folder / "trial.toml").write_text(TRIAL, encoding="utf-8")
    assert main(["hump", "capacity", str(folder / "trial.toml"), "-o", str(folder / "out"), *WORDS]) == 0
    return folder


def summary_of(folder: Path) -> dict[str, list[dict[str, object]]]:
    """The tables of a run."""
    tables: dict[str, list[dict[str, object]]] = json.loads((folder / "summary.json").read_bytes())["tables"]
    return tables


def value(figure: object) -> float:
    """Of a figure with its interval, or alone."""
    return float(figure["value"]) if isinstance(figure, dict) else float(figure)  # type: ignore[arg-type]


def test_a_point_is_the_trial_that_a_user_would_write(humped: Path) -> None:
    """Written as a configuration of its own, and humped by itself; also made from it, and not from the first point."""
    text = f"{TRIAL}[hump_speed]\nconstant_m_s = 3.2\n[[position]]\nnumber = 1\nexit_std_m_s = 0.05\n"
    found = made_trial(resolve_trial(parse_trial_file(text, "written.toml"))).batch(0, 12)
    (point,) = (
        each for each in summary_of(humped / "out")["points"] if each["exit_std_m_s"] == 0.05 and each["value"] == 3.2
    )
    assert value(point["catch_ups"]) == pytest.approx(found.caught.sum() / found.cuts.sum(), rel=1e-12)
    assert value(point["cars_per_hour"]) == pytest.approx(3600.0 * found.span_cars.sum() / found.span_s.sum())


def test_cars_at_the_limit_lie_on_the_line_between_the_points(humped: Path) -> None:
    tables = summary_of(humped / "out")
    for row in tables["capacity"]:
        points = [each for each in tables["points"] if each["curve"] == row["curve"]]
        shares, cars = (np.array([[value(each[key]) for each in points]]) for key in ("catch_ups", "cars_per_hour"))
        crossing = Sums(shares, cars, cars).crossing(0.1)[1][0]
        if row["cars_per_hour"] is None:
            assert row["why"]
        else:
            assert value(row["cars_per_hour"]) == pytest.approx(crossing)


def test_a_run_goes_on_from_what_is_stored_and_gives_the_same_bytes(humped: Path, tmp_path: Path) -> None:
    out = humped / "out"
    stored = sorted((out / "batches").glob("*.npz"))
    assert len(stored) == 4
    before, others = (out / "sheets" / "points.csv").read_bytes(), [each.stat().st_mtime_ns for each in stored[1:]]
    stored[0].unlink()
    assert main(["hump", "capacity", str(humped / "trial.toml"), "-o", str(out), *WORDS]) == 0
    assert (out / "sheets" / "points.csv").read_bytes() == before
    assert [each.stat().st_mtime_ns for each in stored[1:]] == others


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--set", "weather.head_wind=1"), "with weather.head_wind 1, hump_speed.least_s 2: "),
        (("--set", "weather.head_wind_mean_m_s=99"), "head_wind_mean_m_s is 99"),
        (("--set", "hump_speed.least_s=1,2"), "all curves have it in common; give it by --least"),
        (("--set", "trains.seed=1,2"), "give it by --seed"),
        (("--set", "trains.cuts=5,6", "--set", "trains.cuts=7,8"), "given twice"),
        (("--speeds", "2"), "a curve needs 2 to 20 that differ"),
        (("--speeds", "2,nine"), "--speeds is '2,nine'; it must be"),
        (("--exit-std", "0.1", "--workers", "1", "--scheduler", "x"), "--workers and --scheduler"),
    ],
)
def test_what_no_trial_takes_is_refused_in_a_sentence(
    words: tuple[str, ...], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "trial.toml").write_text(TRIAL, encoding="utf-8")
    assert main(["hump", "capacity", str(tmp_path / "trial.toml"), "-o", str(tmp_path / "out"), *words]) == 2
    assert said in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_too_few_cuts_decide_nothing(humped: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--speeds", "2.5,3.2", "--catch-ups", "0.002", "--workers", "1", "-o", str(tmp_path / "out")]
    assert main(["hump", "capacity", str(humped / "trial.toml"), *words]) == 0
    assert "not decidable with these trains: 144 cuts are too few" in " ".join(capsys.readouterr().out.split())


def test_curves_of_other_trains_have_no_difference(humped: Path, tmp_path: Path) -> None:
    words = ["--speeds", "2.5,3.2", "--catch-ups", "0.1", "--workers", "1", "--set", "trains.cuts=12,11"]
    assert main(["hump", "capacity", str(humped / "trial.toml"), "-o", str(tmp_path / "out"), *words]) == 0
    tables = summary_of(tmp_path / "out")
    assert [row["more_cars_per_hour"] for row in tables["capacity"]] == [None, None]
    assert [row["cuts"] for row in tables["points"]] == [144, 144, 132, 132]
