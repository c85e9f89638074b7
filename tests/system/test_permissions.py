"""`retarder-synth permissions` and `tune --permissions` as a user runs them: figures, files, faults, the same bytes."""

from __future__ import annotations

import contextlib
import hashlib
import html
import io
import json
import re
import shutil
from pathlib import Path
from typing import Any

import pytest

from synth.book.permissions.overview import HINT
from synth.book.permissions.refusal import tellable
from synth.book.permissions.shown import AS_CONFIGURED
from synth.checker.finding import Kind
from synth.checker.stated_permissions import permission_faults
from synth.checker.verdict import verify
from synth.cli import main
from synth.configuration.config_file import parse_config
from tests.printed_page import Page, page_about, table_of
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
honesty_low = 0.8
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


def asked(folder: Path, name: str, *words: str, text: str = SMALL, command: str = "permissions") -> int:
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


@pytest.fixture(scope="module")
def tuned(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What tunes with permissions leave on one worker and on two, and what they print."""
    folder = tmp_path_factory.mktemp("tuned")
    for workers in ("1", "2"):
        told = io.StringIO()
        with pytest.MonkeyPatch.context() as patch, contextlib.redirect_stdout(told):
            patch.setenv("SOURCE_DATE_EPOCH", "1700000000")
            words = ("--permissions", "--workers", workers)
            assert asked(folder, workers, *words, text=COARSE, command="tune") in (0, 1)
        (folder / f"{workers}.txt").write_text(told.getvalue(), encoding="utf-8")
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


def test_it_prints_the_figures_of_its_summary(ran: Path, pages: list[Page]) -> None:
    read = summary(ran / "one")
    (row,), page = read["tables"]["permissions"], page_about(pages, ran / "one")
    (told,) = table_of(page)
    assert (told["case"], told["target, m/s"]) == (row["case"], f"{row['target_m_s']:g}")
    assert told["rms as configured, m/s"] == in_brackets(row["configured_m_s"], 4)
    for name in ASKED:
        assert told[name] == in_brackets(row[name], 2)
    ratios = read["figures"]["median_ratios"]
    medians = ", ".join(f"{name} {ratios[name]:.2f}" for name in told if name in ratios)
    assert ratios.keys() == ASKED
    assert str(page[1]).startswith(f"{row['configured_m_s']['n']} stratified passes a case, ")
    assert str(page[1]).endswith(f"Medians: {medians}.")


def in_brackets(told: dict[str, float], digits: int) -> str:
    """A figure with its interval, as people read it."""
    value, low, high = (f"{told[key]:.{digits}f}" for key in ("value", "low95", "high95"))
    return f"{value} [{low}, {high}]"


def test_commands_at_any_time_gain_and_no_approach_and_the_measured_speed_lose(ran: Path) -> None:
    (row,) = summary(ran / "one")["tables"]["permissions"]
    assert row["commands at any time"]["high95"] < 1.0
    assert row["without the approach"]["low95"] > 1.0
    assert row["without the estimator"]["low95"] > 1.0


def test_all_files_are_named_with_their_hashes(ran: Path) -> None:
    files = summary(ran / "one")["files"]
    assert set(files) == {
        "plots/permissions.png", "plots/permissions.svg", "report.html", "sheets/figures.csv", "sheets/permissions.csv",
    }  # fmt: skip
    for name, digest in files.items():
        assert hashlib.sha256((ran / "one" / name).read_bytes()).hexdigest() == digest


def test_the_same_bytes_with_two_workers_and_as_json(
    tuned: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    written = []
    for workers in ("1", "2"):
        assert asked(tmp_path, workers, "--json", "--workers", workers, text=COARSE) == 0
        written.append((tmp_path / workers / "summary.json").read_text(encoding="utf-8"))
        assert capsys.readouterr().out == written[-1]
    assert written[0] == written[1]
    told, (of_tune,) = told_figures(tmp_path / "1"), summary(tuned / "1")["cases"]
    assert set(told) == {*ASKED, "approach of 4 m", AS_CONFIGURED} - {"without the approach"}
    assert told[AS_CONFIGURED]["rms_m_s"]["value"] == of_tune["simulated"]["rms_m_s"]
    for name, each in of_tune["permissions"].items():
        assert told[name]["ratio"]["value"] == each["ratio"]
        assert told[name]["rms_m_s"] == {
            "value": each["rms_m_s"], "low95": each["rms_ci95_m_s"][0], "high95": each["rms_ci95_m_s"][1],
            "n": each["passes"],
        }  # fmt: skip


def test_a_tune_with_permissions_leaves_the_same_bytes_with_two_workers(tuned: Path) -> None:
    one, two = (
        {path.relative_to(tuned / name): path.read_bytes() for path in (tuned / name).rglob("*") if path.is_file()}
        for name in ("1", "2")
    )
    assert one == two


def test_a_tune_tells_permissions_in_one_column_and_one_line(tuned: Path) -> None:
    printed = (tuned / "1.txt").read_text(encoding="utf-8")
    (case,) = summary(tuned / "1")["cases"]
    ratios = {name: f"{each['ratio']:.2f}" for name, each in case["permissions"].items()}
    (row,) = (line for line in printed.splitlines() if line.lstrip().startswith("gondola-4-22t"))
    column = [ratios[name] for name in ("commands at any time", "without the estimator", "approach of 4 m")]
    assert " ".join(row.split()).endswith(f"{' '.join(column)} {case['verdict']}")
    halves = [max(high - e["ratio"], e["ratio"] - low) for e in case["permissions"].values()
              for low, high in [e["ratio_ci95"]]]  # fmt: skip
    (line,) = (line for line in printed.splitlines() if line.startswith("rms × if permitted:"))
    assert float(line.split("±")[1][:4]) == pytest.approx(max(halves) + 0.005, abs=0.0051)
    assert f"on the same {case['simulated']['passes']} passes" in line
    for name, ratio in ratios.items():  # of one case: the medians
        assert re.search(rf"(: |, ){name} {ratio}[,.]", line)
    overall = summary(tuned / "1")["overall"]
    assert f"±{overall['permission_widest_half_ci95']:.2f}" in line
    assert overall["permission_median_ratios"].keys() == ratios.keys()
    page = html.unescape((tuned / "1" / "report.html").read_text(encoding="utf-8"))
    assert line in page
    assert f">{' '.join(column)}</td>" in page
    assert "tune --permissions" not in printed + page


def test_without_the_flag_a_tune_tells_how_to_ask_and_leaves_the_same_tables(
    tuned: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    assert asked(tmp_path, "plain", text=COARSE, command="tune") in (0, 1)
    (plain,), (told,) = summary(tmp_path / "plain")["cases"], summary(tuned / "1")["cases"]
    assert plain["permissions"] is None
    assert plain == {**told, "permissions": None}
    page = (tmp_path / "plain" / "report.html").read_text(encoding="utf-8")
    printed = capsys.readouterr().out
    assert [text.count(HINT) for text in (printed, page)] == [1, 1]
    assert "if permitted" not in printed + page
    for name in ("book.h5", told["table"], "c/retarder_table.c"):
        assert (tmp_path / "plain" / name).read_bytes() == (tuned / "1" / name).read_bytes()


def test_the_checker_finds_a_ratio_that_is_not_one_of_the_figures_beside_it(tuned: Path, tmp_path: Path) -> None:
    out = Path(shutil.copytree(tuned / "1", tmp_path / "out"))
    assert not [finding for finding in verify(out, 100, 1).findings if finding.kind is Kind.DISAGREES]
    told = summary(out)
    told["cases"][0]["permissions"]["commands at any time"]["ratio"] *= 0.99
    (out / "summary.json").write_text(json.dumps(told), encoding="utf-8")
    (finding,) = (finding for finding in verify(out, 100, 1).findings if finding.kind is Kind.DISAGREES)
    assert "says of its permission 'commands at any time' a ratio of" in finding.sentence


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({}, None),
        ({"ratio": 0.81}, "a ratio of 0.81, but its rms is 0.04 and that of the table 0.05"),
        ({"ratio_ci95": [0.81, 0.9]}, "outside its interval"),
        ({"passes": 10}, "10 passes, but 2000 of the table"),
        ({"ratio_ci95": [0.7, None]}, "no rms and no ratio with an interval"),
        ({"rms_m_s": True}, "no rms and no ratio with an interval"),
    ],
)
def test_the_checker_tells_what_is_wrong_with_a_permission(change: dict[str, object], says: str | None) -> None:
    figures = {"rms_m_s": 0.04, "ratio": 0.8, "ratio_ci95": [0.75, 0.85], "passes": 2000, **change}
    case = {"simulated": {"rms_m_s": 0.05, "passes": 2000}, "permissions": {"estimator": figures}}
    found = list(permission_faults(case))
    assert len(found) == (says is not None)
    assert all(str(says) in fault for fault in found)
    assert list(permission_faults({**case, "permissions": None})) == []
    assert len(list(permission_faults({**case, "permissions": {}}))) == 1


@pytest.mark.parametrize(("command", "name"), [("permissions", "permissions"), ("tune", "--permissions")])
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
    tmp_path: Path, capsys: pytest.CaptureFixture[str], lines: str, says: str, command: str, name: str
) -> None:
    words = ("--permissions",) if command == "tune" else ()
    assert asked(tmp_path, "out", *words, text=SMALL + lines, command=command) == 2
    told = capsys.readouterr().err
    assert says in told
    assert f" {name} " in told
    assert str(tmp_path / "c.toml") in told
    assert not (tmp_path / "out").exists()
    assert not tellable(parse_config(SMALL + lines, "c.toml"))
