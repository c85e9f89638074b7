"""`retarder-synth hardware` as a user runs it: figures, files, faults, the same bytes."""

from __future__ import annotations

import html
import json
from pathlib import Path
from typing import Any

import pytest

from synth.cli import main
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.permissions.permission import tellable
from synth.retarder.permissions.shown import AS_CONFIGURED
from synth.retarder.shown.results import PERMISSIONS
from tests.system.conftest import MEASURED

SMALL = """\
[position]
name = "rnz-2m-park"
[targets]
exit_speeds_m_s = [2.5]
[grid]
path_step_m = 0.5
[validation]
passes = 8000
[[cut]]
car = "gondola-4"
mass_t = 36
"""

COARSE = """\
[position]
name = "rnz-2m-park"
[entry]
high_m_s = 4.0
[targets]
exit_speeds_m_s = [2.5]
[grid]
path_step_m = 1.0
speed_step_m_s = 0.05
friction_scenarios = 3
resistance_scenarios = 1
[fit]
degree = 2
[validation]
passes = 1000
[acceptance]
prediction_ratio_low = 0.8
[regulator]
approach_m = 0.0
[output]
plots = false
[[cut]]
car = "gondola-4"
mass_t = 22
"""
"""From the entrance, so that an approach can be asked for."""

ASKED = {
    "commands at any time",
    "commands at any time, no pressure gauge",
    "without the estimator",
    "without the approach",
}


def asked(folder: Path, name: str, *words: str, text: str = SMALL, command: str = "hardware") -> int:
    """The exit code of a run into a directory of that name."""
    (folder / "c.toml").write_text(text, encoding="utf-8")
    return main([command, str(folder / "c.toml"), "-o", str(folder / name), *words])


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The results of a small run."""
    folder = tmp_path_factory.mktemp("permissions")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", "1700000000")
        assert asked(folder, "one", "--workers", "1") == 0
    return folder


def summary(folder: Path) -> dict[str, Any]:
    """summary.json."""
    read: dict[str, Any] = json.loads((folder / "summary.json").read_bytes())
    return read


def told_figures(folder: Path) -> dict[str, dict[str, Any]]:
    """Every figure of the only case, by permission."""
    return {row["permission"]: row for row in summary(folder)["tables"]["figures"]}


def test_every_permission_is_told_with_its_interval(ran: Path) -> None:
    told = told_figures(ran / "one")
    assert set(told) == {*ASKED, AS_CONFIGURED}
    configured = told[AS_CONFIGURED]["rms_m_s"]
    for each in (told[name] for name in ASKED):
        assert each["ratio"]["low95"] < each["ratio"]["value"] < each["ratio"]["high95"]
        assert each["rms_m_s"]["n"] == configured["n"] == 8000
        assert each["ratio"]["value"] == pytest.approx(each["rms_m_s"]["value"] / configured["value"])
        assert 0.85 < each["predicted_rms_m_s"] / each["rms_m_s"]["value"] < 1.15


def test_commands_at_any_time_gain_and_no_approach_and_the_measured_speed_lose(ran: Path) -> None:
    (row,) = summary(ran / "one")["tables"]["permissions"]
    assert row["commands at any time"]["high95"] < 1.0
    assert row["without the approach"]["low95"] > 1.0
    assert row["without the estimator"]["low95"] > 1.0


def test_the_page_says_which_permission_to_ask_for(ran: Path) -> None:
    """The one of least rms, where it is smaller for sure; a tile tells the median of each."""
    read, page = summary(ran / "one"), (ran / "one" / "report.html").read_text(encoding="utf-8")
    ratios = read["figures"]["median_ratios"]
    best = min(ratios, key=ratios.get)
    head = html.unescape(page.partition("<h2>")[0])
    assert f"Ask what '{best}' costs: it gives {ratios[best]:.2f} times the rms" in head
    assert "smaller for sure in 1 of 1 case" in head
    for name, ratio in ratios.items():
        assert f"<strong>{ratio:.2f} times</strong><p>the rms as configured, in the median: {name}</p>" in head


@pytest.mark.long
def test_the_table_as_configured_is_that_of_a_tune_which_tells_how_to_ask(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert asked(tmp_path, "tuned", text=COARSE, command="tune") in (0, 1)
    page = (tmp_path / "tuned" / "report.html").read_text(encoding="utf-8")
    assert [text.count(PERMISSIONS) for text in (capsys.readouterr().out, page)] == [1, 1]
    assert asked(tmp_path, "told", text=COARSE) == 0
    (case,) = summary(tmp_path / "tuned")["tables"]["cases"]
    assert told_figures(tmp_path / "told")[AS_CONFIGURED]["rms_m_s"] == case["rms_m_s"]


@pytest.mark.parametrize(
    ("lines", "says"),
    [
        (
            MEASURED + "[criterion]\np_overspeed = 0.01\n",
            "commands at any time are designed for the mean square error alone",
        ),
        ("[sensor]\ncomputing_delay_s = 0.3\n", "computing_delay_s is 0.3"),
        ('[regulator]\ncommands = "any_time"\n', "what to ask the hardware for beyond commands at rest"),
    ],
)
def test_what_cannot_be_worked_out_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], lines: str, says: str
) -> None:
    assert asked(tmp_path, "out", text=SMALL + lines) == 2
    told = capsys.readouterr().err
    assert says in told
    assert " 'hardware' " in told
    assert str(tmp_path / "c.toml") in told
    assert not (tmp_path / "out").exists()
    assert not tellable(parse_config(SMALL + lines, "c.toml"))
