"""Capacity: the command, crossings and variants.

The command: its points are the trials that a user would write, and its figures those of their trains.
Where a curve crosses a share, and what its bootstrap decides, against closed forms.
Changes to a trial by key: every combination, in order, and nothing else of the trial.
"""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

import numpy as np
import pytest

from synth.cli import main
from synth.frame.faults import InputError
from synth.hump.capacity.curves import REPLICATES, Sums, decided, drawn_weights, enough_for
from synth.hump.capacity.variants import KeyValues, changed_text, key_values, variants
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.trial.made_trial import made_trial
from synth.hump.trial.resolved_trial import resolve_trial

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


def test_a_curve_crosses_a_limit_where_the_line_between_two_programs_does() -> None:
    share = np.array([[0.0, 0.002, 0.006], [0.002, 0.003, 0.004], [0.0, 0.0, 0.0005]])
    speed = np.array([[2.0, 2.2, 2.6]] * 3)
    crossed, cars = Sums(share, speed, 300.0 * speed).crossing(0.001)
    assert crossed.tolist() == pytest.approx([2.1, -np.inf, np.inf])
    assert cars.tolist() == pytest.approx([630.0, -np.inf, np.inf])
    assert Sums(share, speed, speed).crossing(0.004)[0][0] == pytest.approx(2.4)


def test_a_curve_is_read_at_a_speed_between_its_programs_and_nowhere_else() -> None:
    sums = Sums(np.array([[0.0, 0.1, 0.4]]), np.array([[2.0, 2.5, 3.0]]), np.zeros((1, 3)))
    assert sums.at_speed(2.25).tolist() == pytest.approx([0.05])
    assert sums.at_speed(3.0).tolist() == pytest.approx([0.4])
    assert np.isnan(sums.at_speed(1.9)).all()
    assert np.isnan(sums.at_speed(3.1)).all()


def test_bootstrap_intervals_are_those_of_a_mean_of_independent_trains() -> None:
    caught = np.random.default_rng(1).poisson(0.5, 400).astype(float)
    found = decided(drawn_weights(400, 2) @ caught / 400, 400)
    assert found is not None
    half = 1.96 * caught.std(ddof=1) / np.sqrt(400)
    assert found.value == pytest.approx(caught.mean())
    assert found.n == 400
    assert (found.low95, found.high95) == pytest.approx((caught.mean() - half, caught.mean() + half), abs=0.15 * half)
    assert decided(np.concatenate(([1.0], np.full(REPLICATES, np.inf))), 9) is None
    assert decided(np.concatenate(([np.nan], np.ones(REPLICATES))), 9) is None


def test_intervals_at_a_limit_hold_the_truth() -> None:
    """Trains whose catch-ups are Poisson numbers about a straight curve, common to all points of it as trains are.

    The truth is where the mean curve crosses 1 %: at 620 cars an hour. 95 of 100 are wanted; of 300 samples 91 to 98
    of 100 are within three standard deviations of that.
    """
    cars, mean = np.array([580.0, 620.0, 660.0]), np.array([0.002, 0.01, 0.018])
    held, samples, trains, cuts = 0, 300, 60, 40
    rng = np.random.default_rng(11)
    for sample in range(samples):
        worse = rng.gamma(8.0, 1.0 / 8.0, (trains, 1))  # some trains are worse than others at every point
        share = rng.poisson(cuts * mean * worse) / cuts
        weights = drawn_weights(trains, sample)
        caught = weights @ share / trains
        found = decided(Sums(caught, caught, np.tile(cars, (len(caught), 1))).crossing(0.01)[1], trains)
        held += found is None or found.low95 <= 620.0 <= found.high95
    assert 0.91 * samples <= held <= 0.985 * samples


def test_a_share_needs_enough_cuts() -> None:
    assert enough_for(0.002, 5000)
    assert not enough_for(0.002, 4999)


TEXT = """hump = "medium"
[weather]
head_wind_mean_m_s = 1.0
head_wind_std_m_s = 2.0
[[position]]
number = 2
exit_std_m_s = 0.1
"""


def test_every_combination_is_told_by_its_values_and_changes_its_keys() -> None:
    both = KeyValues("exit_std_m_s", ("position.1.exit_std_m_s", "position.2.exit_std_m_s"), (0.3, 0.1))
    found = variants([both, key_values("weather.head_wind_mean_m_s = 0, 6")])
    assert [dict(each.told) for each in found] == [
        {"exit_std_m_s": std, "weather.head_wind_mean_m_s": wind} for std in (0.3, 0.1) for wind in (0, 6)
    ]
    assert found[1].name == "exit_std_m_s 0.3, weather.head_wind_mean_m_s 6"
    tree = tomllib.loads(changed_text(TEXT, "trial.toml", found[1].changes))
    assert tree == tomllib.loads(TEXT) | {
        "weather": {"head_wind_mean_m_s": 6, "head_wind_std_m_s": 2.0},
        "position": [{"number": 2, "exit_std_m_s": 0.3}, {"number": 1, "exit_std_m_s": 0.3}],
    }


def test_without_a_key_it_is_the_trial_as_it_is() -> None:
    (only,) = variants([])
    assert only.name == ""
    assert tomllib.loads(changed_text(TEXT, "trial.toml", only.changes)) == tomllib.loads(TEXT)


def test_values_are_those_of_toml_and_other_words_are_text() -> None:
    assert key_values("a.b=1,0.5,true,pair-by-pair").values == (1, 0.5, True, "pair-by-pair")
    for word in ("1979-05-27", "9" * 5000, "[" * 5000, "[1]"):
        assert key_values(f"a.b={word}").values == (word,)


@pytest.mark.parametrize("words", ["weather", "=1", "weather.x=", f"{'a.' * 5000}b=1"])
def test_what_is_no_key_with_values_is_refused(words: str) -> None:
    with pytest.raises(InputError, match="must be a key and its values"):
        key_values(words)


@pytest.mark.parametrize(
    ("key", "said"),
    [
        ("position.first.exit_std_m_s", "its number"),
        (f"position.{'9' * 5000}.exit_std_m_s", "its number"),
        ("hump.x", "hump is no table of keys"),
    ],
)
def test_a_key_that_cannot_be_is_refused(key: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        changed_text(TEXT, "trial.toml", {key: 1.0})
