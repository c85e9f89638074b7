"""From a trial to the tables that it needs and back: `init --for`, `tune`, `hump simulate`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.system.conftest import Command

TRIAL = """\
hump = "dumper"
[trains]
number = 4
cuts = 20
most_cars = 1
category_shares = { L = 1.0 }
[aim]
highest_m_s = 2.0
design_cuts = 200
[output]
plots = false
report = false
"""
BOOKED = """\
[[position]]
number = 1
tables = "park/book.h5"
tables_config = "park.toml"
"""
COARSE = """\
[grid]
path_step_m = 1.0
speed_step_m_s = 0.05
friction_scenarios = 3
resistance_scenarios = 1
[fit]
degree = 2
[validation]
passes = 1000
[output]
plots = false
report = false
"""


@pytest.mark.long
def test_the_tables_that_a_trial_asks_for_run_in_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: Command
) -> None:
    """The trial names the book before there is one; then its cuts leave with the error that the tables predict."""
    monkeypatch.chdir(tmp_path)
    Path("trial.toml").write_text(TRIAL + BOOKED, encoding="utf-8")
    assert "'retarder-synth init --for' prints the configuration" in command("hump", "simulate", "trial.toml").sentence
    printed = command("init", "--for", "trial.toml").out
    assert "retarder-synth tune park.toml -o park\n" in printed
    Path("park.toml").write_text(f"{printed}\n{COARSE}", encoding="utf-8")
    assert command("tune", "park.toml", "-o", "park").code in (0, 1)
    simulated = command("hump", "simulate", "trial.toml", "-o", "humped")
    assert "position 1 aims with" not in simulated.err
    summary = json.loads(Path("humped/summary.json").read_bytes())
    assert summary["warnings"] == []
    (position,) = summary["tables"]["positions"]
    assert 0.0 < position["rms_of_exit_less_command_m_s"]["value"] < 2.0 * position["stated_exit_std_m_s"]
    assert position["strokes_per_pass"]["value"] > 1.0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--for", "medium"], "medium: --position-number is missing; the hump has the positions 1 (knp-5-bunch), 2"),
        (["--for", "medium", "--position-number", "4"], "medium: --position-number is 4; the hump has the positions 1"),
        (["--position-number", "1"], "init --position-number is for --for TRIAL.toml, the trial whose position it is"),
        (["--for", "medium", "--schema"], "init --for prints the configuration of tables for a trial; give neither"),
        (["--for", "nix.toml"], "nix.toml: there is no such file; write one with 'retarder-synth init trial"),
    ],
)
def test_what_is_not_said_is_asked_for(command: Command, words: list[str], said: str) -> None:
    ran = command("init", *words)
    assert ran.code == 2
    assert ran.sentence.startswith(said)


def test_a_position_out_of_service_needs_no_tables(tmp_path: Path, command: Command) -> None:
    trial = tmp_path / "trial.toml"
    trial.write_text('hump = "medium"\n[[position]]\nnumber = 1\nout_of_service = true\n', encoding="utf-8")
    ran = command("init", "--for", trial, "--position-number", "1")
    assert ran.sentence == f"{trial}: position 1 is out of service; it needs no tables"
