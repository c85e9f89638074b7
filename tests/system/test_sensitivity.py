"""`retarder-synth sensitivity` as a user runs it: files, figures, exit codes, the same bytes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from synth.cli import main
from synth.frame.results_directory import results_directory

SMALL = """\
[position]
name = "rnz-2m-park"
[retarder.force]
slope_factor_by_axles = [1.0, 1.001]
[entry]
high_m_s = 4.0
low_m_s = 2.5
[targets]
exit_speeds_m_s = [1.5]
[grid]
path_step_m = 1.0
speed_step_m_s = 0.04
transient_step_s = 0.05
friction_scenarios = 3
resistance_scenarios = 1
[fit]
degree = 2
[[cut]]
car = "gondola-4"
mass_t = 22
"""
"""A park retarder, one light class and one target; a yard that knows its entry speeds and its c(n)."""

LEFT = {"together", "noise"}
SLOPE = ("retarder.force.slope_kn_per_kpa", "retarder.force.slope_kn_per_kpa_per_t")


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The results of a small run."""
    folder = tmp_path_factory.mktemp("sensitivity")
    (folder / "c.toml").write_text(SMALL, encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", "1700000000")
        assert asked(folder, "one") == 0
    return folder


def asked(folder: Path, name: str, *words: str) -> int:
    """The exit code of a run of 300 plants into a directory of that name."""
    return main(["sensitivity", str(folder / "c.toml"), "-o", str(folder / name), "--points", "300", *words])


def tables(folder: Path) -> dict[str, Any]:
    """The tables of summary.json."""
    read: dict[str, Any] = json.loads((folder / "summary.json").read_bytes())["tables"]
    return read


def figures(folder: Path) -> dict[str, Any]:
    """The figures of its sentences."""
    read: dict[str, Any] = json.loads((folder / "summary.json").read_bytes())["figures"]
    return read


def test_the_slope_of_the_force_comes_first_for_the_bias(ran: Path) -> None:
    rows = [row for row in tables(ran / "one")["overall"] if row["key"] not in LEFT]
    first = max(rows, key=lambda row: row["bias_m_s"]["value"])
    assert first["key"] in SLOPE
    assert first["bias_m_s"]["low95"] > 0.0
    assert figures(ran / "one")["first_bias_m_s"] == first["key"]


def test_shares_what_is_together_and_noise_are_all(ran: Path) -> None:
    rows = tables(ran / "one")["cases"]
    for output in ("rms_m_s", "bias_m_s", "overspeed"):
        parts = {row["key"]: row[output]["value"] for row in rows if row[output] is not None}
        if parts:
            assert sum(parts.values()) == pytest.approx(1.0, abs=1e-9)
            assert parts["noise"] < 0.2
            assert min(parts.values()) > -0.3


def test_what_the_configuration_sets_is_held(ran: Path) -> None:
    told = tables(ran / "one")
    held = {row["key"] for row in told["held"]}
    assert {"entry.low_m_s", "entry.high_m_s", "retarder.force.slope_factor_by_axles"} <= held
    keys = {row["key"] for row in told["overall"]} - LEFT
    assert keys.isdisjoint(held)
    assert {"cut.mass_t", "friction.common_cv", "sensor.noise_m_s"} <= keys
    assert {row["key"] for row in told["ranges"]} == keys
    assert all(row["low"] <= row["nominal"] <= row["high"] for row in told["ranges"])


@pytest.mark.long
def test_a_table_of_a_tune_gives_the_shares_of_the_table_made_here(
    ran: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    assert main(["tune", str(ran / "c.toml"), "-o", str(ran / "tuned")]) in (0, 1)
    capsys.readouterr()
    assert asked(ran, "given", "--table", str(ran / "tuned"), "--json") == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["tables"], told["figures"]) == (tables(ran / "one"), figures(ran / "one"))


def test_what_cannot_be_is_refused_in_a_sentence(ran: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with results_directory(ran / "of a tune", "tune", ()) as of_a_tune:
        of_a_tune.write("tables/a.json", b"{}")
    assert asked(ran, "of a tune") == 2
    assert "it holds the results of 'tune'" in capsys.readouterr().err
    assert main(["sensitivity", "--points", "100"]) == 2
    assert "a whole number from 200" in capsys.readouterr().err
    assert asked(ran, "none", "--table", str(ran / "one" / "summary.json")) in (2, 3)
    err = capsys.readouterr().err
    assert "summary.json" in err
    assert err.count("\n") == 1
