"""Where tables come from: file, book and folder are one, a trial asks for those it needs, `--pareto` gives a
front.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from synth.cli import main
from synth.frame.faults import InputError
from synth.retarder.case_result import PRICES_M2_S3
from synth.retarder.forms.tables_at import book_in, tables_at
from tests.printed_page import Page, page_about
from tests.system.conftest import Command

ID = "gondola-4-22t-to-1.5-m-s"


def sources(tuned: Path) -> tuple[Path, Path, Path]:
    return tuned / "tables" / f"{ID}.json", tuned / "book.h5", tuned


def test_all_three_hold_the_same_tables(tuned: Path) -> None:
    alone, book, folder = (tables_at(source).only_lines("a test") for source in sources(tuned))
    assert book == folder == tables_at(tuned / "tables").only_lines("a test")[:: 1 if book[0].id == ID else -1]
    assert alone == tuple(table for table in book if table.id == ID)
    assert book_in(tuned) == book_in(tuned / "book.h5") == tuned / "book.h5"
    assert book_in(tuned / "tables") == tuned / "tables"


def test_commands_beside_the_frame_take_all_three(command: Command, tuned: Path, tmp_path: Path) -> None:
    for place, source in enumerate(sources(tuned)):
        verified = json.loads(command("verify", source, "--passes", "100", "--json").out)
        assert ID in {each["id"] for each in verified["tables"]}
        assert f"{ID}: leave with 1.5 m/s" in command("inspect", source).out
        written = json.loads(command("export", source, "--format", "csv", "-o", tmp_path / str(place), "--json").out)
        assert str(tmp_path / str(place) / f"{ID}.csv") in written["files"]


def test_sensitivity_takes_a_folder(command: Command, tuned: Path, two_classes: Path, tmp_path: Path) -> None:
    ran = command(
        "sensitivity", two_classes, "--table", tuned, "--points", "200", "--passes", "100", "-o", tmp_path / "out", "-q"
    )
    assert (ran.code, ran.err) == (0, "")


@pytest.mark.parametrize("what", ["empty", "nothing"])
def test_where_there_is_none_one_sentence_says_so(command: Command, tmp_path: Path, what: str) -> None:
    (tmp_path / "empty").mkdir()
    for words in (("validate",), ("inspect",), ("verify",), ("export", "--format", "c")):
        ran = command(*words, tmp_path / what)
        assert (ran.code, ran.out) == (2, "")
        assert str(tmp_path / what) in ran.sentence
    with pytest.raises(InputError, match=what):
        tables_at(tmp_path / what)


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


FRONT = """\
[position]
name = "rnz-2m-park"
[targets]
exit_speeds_m_s = [2.5]
[grid]
path_step_m = 0.5
speed_step_m_s = 0.05
friction_scenarios = 3
resistance_scenarios = 1
[validation]
passes = 1000
[[cut]]
car = "gondola-4"
mass_t = 22
"""


@pytest.mark.long
def test_time_falls_with_its_price(tmp_path: Path, pages: list[Page]) -> None:
    """The dearest table is quicker and no more accurate; the cheapest is the one that the tune exports."""
    (tmp_path / "c.toml").write_text(FRONT, encoding="utf-8")
    out = tmp_path / "out"
    assert main(["tune", str(tmp_path / "c.toml"), "-o", str(out), "--pareto"]) in (0, 1)
    tables = json.loads((out / "summary.json").read_bytes())["tables"]
    (case,), points = tables["cases"], tables["fronts"]
    assert [each["time_price_m2_s3"] for each in points] == list(PRICES_M2_S3)
    assert points[0]["rms_m_s"]["value"] == pytest.approx(case["rms_m_s"]["value"])
    assert points[0]["time_s"] == case["time_s"]
    assert points[-1]["time_s"]["high95"] < points[0]["time_s"]["low95"]
    assert points[-1]["ratio"]["high95"] > 1.0
    assert points[0]["ratio"]["value"] == 1.0
    told = [each for each in page_about(pages, out) if isinstance(each, str) and " a second " in each]
    assert len(told) == 1
    assert (out / "plots" / "pareto-fronts.svg").exists()
    assert "Accuracy against time" in (out / "report.html").read_text(encoding="utf-8")
