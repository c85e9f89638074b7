"""`retarder-synth sensitivity` as a user runs it: files, figures, exit codes, the same bytes."""

from __future__ import annotations

import csv
import hashlib
import json
from pathlib import Path
from typing import Any

import pytest

import synth.cli.sensitivity as command
from synth.cli import main
from tests.frame.results import results_in

SMALL = """\
[retarder]
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


def document(folder: Path) -> dict[str, Any]:
    """sensitivity.json."""
    read: dict[str, Any] = json.loads((folder / "sensitivity.json").read_bytes())
    return read


def test_the_slope_of_the_force_comes_first_for_the_bias(ran: Path) -> None:
    bias = next(each for each in document(ran / "one")["overall"] if each["output"] == "bias_m_s")
    assert bias["shares"][0]["key"] in SLOPE
    assert bias["shares"][0]["decided"]


def test_shares_what_is_together_and_noise_are_all(ran: Path) -> None:
    for each in document(ran / "one")["cases"][0]["outputs"]:
        if each["shares"]:
            parts = [share["share"] for share in each["shares"]]
            parts += [each["noise"]["share"], each["together"]["share"]]
            assert sum(parts) == pytest.approx(1.0, abs=1e-4)
            assert each["noise"]["share"] < 0.2
            assert min(parts) > -0.3


def test_what_the_configuration_sets_is_held(ran: Path) -> None:
    told = document(ran / "one")
    assert {"entry.low_m_s", "entry.high_m_s", "retarder.force.slope_factor_by_axles"} <= set(told["held"])
    keys = {each["key"] for each in told["parameters"]}
    assert keys.isdisjoint(told["held"])
    assert {"cut.mass_t", "friction.common_cv", "sensor.noise_m_s"} <= keys
    for one in told["ranges"].values():
        assert all(each["low"] <= each["nominal"] <= each["high"] for each in one.values())


def test_same_bytes_whatever_the_threads(ran: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    monkeypatch.setattr(command, "available", lambda: 3)
    assert asked(ran, "three") == 0
    assert len(results_in(ran / "one")) == 8
    assert results_in(ran / "one") == results_in(ran / "three")


def test_files_are_those_of_the_summary_and_csv_says_what_the_document_says(ran: Path) -> None:
    summary = json.loads((ran / "one" / "summary.json").read_bytes())
    for name, digest in summary["files"].items():
        assert hashlib.sha256((ran / "one" / name).read_bytes()).hexdigest() == digest
    with (ran / "one" / "sensitivity.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    shares = {(row["label"], row["output"], row["key"]): float(row["share"]) for row in rows}
    told = document(ran / "one")
    for case in told["cases"]:
        for each in case["outputs"]:
            for share in each["shares"]:
                assert shares[case["label"], each["output"], share["key"]] == pytest.approx(share["share"], abs=1e-6)
    page = (ran / "one" / "report.html").read_text(encoding="utf-8")
    assert told["measure_first"][0] in page


def test_a_table_of_a_tune_gives_the_shares_of_the_table_made_here(
    ran: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    assert main(["tune", str(ran / "c.toml"), "-o", str(ran / "tuned")]) in (0, 1)
    capsys.readouterr()
    assert asked(ran, "given", "--table", str(ran / "tuned"), "--json") == 0
    assert json.loads(capsys.readouterr().out) == document(ran / "one")


def test_what_cannot_be_is_refused_in_a_sentence(ran: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert asked(ran, "tuned") == 2
    assert "it holds the results of 'tune'" in capsys.readouterr().err
    assert main(["sensitivity", "--points", "100"]) == 2
    assert "a whole number from 200" in capsys.readouterr().err
    assert asked(ran, "none", "--table", str(ran / "one" / "sensitivity.json")) in (2, 3)
    err = capsys.readouterr().err
    assert "sensitivity.json" in err
    assert err.count("\n") == 1
