"""`retarder-synth permissions` as a user runs it: figures, files, faults, the same bytes."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

import pytest

from synth.cli import main

SMALL = """\
[position]
name = "rnz-2m-park"
[targets]
exit_speeds_m_s = [2.5]
[grid]
path_step_m = 0.5
[validation]
passes = 2000
[[cut]]
car = "gondola-4"
mass_t = 36
"""

ASKED = {
    "several stages a command",
    "commands at any time",
    "commands at any time, no pressure gauge",
    "estimator",
    "commands at any time, estimator",
    "without the approach",
}


def asked(folder: Path, name: str, *words: str, text: str = SMALL) -> int:
    """The exit code of a run into a directory of that name."""
    (folder / "c.toml").write_text(text, encoding="utf-8")
    return main(["permissions", str(folder / "c.toml"), "-o", str(folder / name), *words])


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


def test_every_permission_is_told_with_its_interval(ran: Path) -> None:
    (case,) = summary(ran / "one")["cases"]
    assert set(case["permissions"]) == ASKED
    for each in case["permissions"].values():
        low, high = each["ratio_ci95"]
        assert low < each["ratio"] < high
        assert each["passes"] == case["as_configured"]["passes"] == 2000
        assert each["ratio"] == pytest.approx(each["rms_m_s"] / case["as_configured"]["rms_m_s"])
        assert 0.85 < each["predicted_rms_m_s"] / each["rms_m_s"] < 1.15


def test_commands_at_any_time_gain_and_no_approach_loses(ran: Path) -> None:
    permissions = summary(ran / "one")["cases"][0]["permissions"]
    assert permissions["commands at any time"]["ratio_ci95"][1] < 1.0
    assert permissions["without the approach"]["ratio_ci95"][0] > 1.0


def test_jumps_save_commands_and_an_estimator_gains_at_any_time_too(ran: Path) -> None:
    case = summary(ran / "one")["cases"][0]
    permissions, jumps = case["permissions"], case["permissions"]["several stages a command"]
    assert jumps["switchings"] < case["as_configured"]["switchings"] - 0.5
    assert jumps["ratio_ci95"][0] < 1.0
    both = permissions["commands at any time, estimator"]
    assert both["ratio_ci95"][1] < permissions["commands at any time"]["ratio"]


def test_all_files_are_named_with_their_hashes(ran: Path) -> None:
    files = summary(ran / "one")["files"]
    assert set(files) == {"plots/permissions.png", "plots/permissions.svg"}
    for name, digest in files.items():
        assert hashlib.sha256((ran / "one" / name).read_bytes()).hexdigest() == digest


def test_the_same_bytes_with_two_workers_and_as_json(
    ran: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    from_the_entrance = SMALL.replace("2000", "1000") + "[regulator]\napproach_m = 0.0\nestimator = true\n"
    written = []
    for workers in ("1", "2"):
        assert asked(ran, workers, "--json", "--workers", workers, text=from_the_entrance) == 0
        written.append((ran / workers / "summary.json").read_text(encoding="utf-8"))
        assert capsys.readouterr().out == written[-1]
    assert written[0] == written[1]
    (case,) = json.loads(written[0])["cases"]
    left_out = {"estimator", "commands at any time, estimator", "without the approach"}
    assert set(case["permissions"]) == {*ASKED, "approach of 4 m"} - left_out


@pytest.mark.parametrize(
    ("lines", "says"),
    [
        ("[criterion]\np_overspeed = 0.01\n", "commands at any time are designed for the mean square error alone"),
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
    assert str(tmp_path / "c.toml") in told
    assert not (tmp_path / "out" / "summary.json").exists()
