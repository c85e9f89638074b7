"""`retarder-synth tune`, and what other commands make of its tables."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from synth.checker.finding import Kind
from synth.checker.verdict import verify
from synth.cli import main
from tests.checker.planted_fault import rewrite
from tests.frame.small_command import results_in
from tests.printed_page import Page, table_of
from tests.system.conftest import EPOCH, MEASURED, Command, changed
from tuning_tables.json_file import read_json
from tuning_tables.passages.passage_table import PassageTable

CONFIG = """\
[position]
name = "rnz-2m-dumper"
[targets]
exit_speeds_m_s = [2.0, 2.5]
[grid]
path_step_m = 1.0
speed_step_m_s = 0.04
friction_scenarios = 3
resistance_scenarios = 1
[validation]
passes = 1000
[acceptance]
rms_m_s = 0.2
prediction_ratio_low = 0.7
prediction_ratio_high = 1.4
[output]
csv = true
[sensors]
path_m = [-4.5, 0.0, 4.0, 8.0, 12.0, 16.0, 22.5]
[[cut]]
car = "gondola-4"
mass_t = 22
allowed_stage = 3
"""
"""One empty car behind a car dumper, on a coarse grid."""

TABLE = "gondola-4-22t-to-2-m-s"


@pytest.fixture(scope="module")
def config(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Configuration with point sensors."""
    path = tmp_path_factory.mktemp("sensors") / "points.toml"
    path.write_text(CONFIG)
    return path


@pytest.fixture(scope="module")
def tuned_points(config: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What a tune leaves; not to be changed."""
    directory = tmp_path_factory.mktemp("points") / "out"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", EPOCH)
        assert main(["tune", str(config), "-o", str(directory), "--workers", "1"]) == 0
    return directory


def test_it_leaves_tables_code_pictures_report_and_a_summary_of_them_all(tuned_points: Path) -> None:
    summary = json.loads((tuned_points / "summary.json").read_bytes())
    here = set(results_in(tuned_points))
    assert here == {*summary["files"], "summary.json"}
    assert {name.partition("/")[0] for name in here} == {
        "tables", "c", "st", "plots", "sheets", "configuration.toml", "report.html", "summary.json",
    }  # fmt: skip
    assert {Path(name).suffix for name in here if name.startswith("tables/")} == {".json", ".csv"}
    assert sum(name.startswith("plots/") for name in here) == 3  # three pictures of the class
    assert "<h2>Sensors and passages</h2>" in (tuned_points / "report.html").read_text(encoding="utf-8")
    assert summary["accepted"] is True
    assert [case["target_speed_m_s"] for case in summary["tables"]["cases"]] == [2.0, 2.5]


def test_tables_say_what_was_predicted_and_simulated(tuned_points: Path) -> None:
    summary = json.loads((tuned_points / "summary.json").read_bytes())
    for case in summary["tables"]["cases"]:
        table = read_json(tuned_points / "tables" / f"{case['id']}.json", PassageTable)
        assert table.validated is not None
        assert table.validated.rms_m_s == case["rms_m_s"]["value"]
        assert table.predicted.rms_m_s == case["predicted_rms_m_s"]
        # Two computations of one number, on a coarse grid and with few passes.
        assert 0.7 < case["prediction_ratio"]["value"] < 1.4
        unavoidable = case["unavoidable_rms_m_s"]
        assert 0.0 < unavoidable["low95"] < unavoidable["value"] < unavoidable["high95"]
        assert unavoidable["value"] < case["rms_m_s"]["value"]
        target = case["target_speed_m_s"]
        passages = [row for row in summary["tables"]["passages"] if row["target_speed_m_s"] == target]
        assert [row["path_m"] for row in passages] == [-4.5, 0.0, 4.0, 8.0, 12.0, 16.0]
        assert all(row["mistaken"]["value"] == 0.0 for row in passages)
        assert np.isfinite(table.switching_m_s[:, 0, 0]).all()
        assert (table.switching_m_s[:, 3, 3] == np.inf).all()  # stage 4 is not allowed


def validated(command: Command, table: Path, config: Path, out: Path) -> tuple[int, dict[str, Any]]:
    """The exit code of a `validate`, and what it tells of the only table."""
    ran = command("validate", table, "--config", config, "--json", "-o", out)
    (found,) = json.loads(ran.out)["tables"]["tables"]
    return ran.code, found


def test_validate_confirms_the_file_and_notices_other_sensors(
    command: Command, tuned_points: Path, config: Path, tmp_path: Path
) -> None:
    table = tuned_points / "tables" / f"{TABLE}.json"
    code, found = validated(command, table, config, tmp_path / "one")
    assert code == 0
    assert (found["confirmed"], found["same_config"]) == (True, True)
    # The same passes as of the tune, though drawn in bounded memory.
    assert found["rms_m_s"]["value"] == pytest.approx(found["stated_rms_m_s"]["value"], rel=1e-12)
    worse = tmp_path / "worse.toml"
    worse.write_text(changed(CONFIG, ("[sensors]\n", "[sensors]\ntimer_noise_s = 0.02\n")))
    _, other = validated(command, table, worse, tmp_path / "other")
    assert other["rms_m_s"]["value"] > 1.1 * found["rms_m_s"]["value"]
    moved = tmp_path / "moved.toml"
    moved.write_text(changed(CONFIG, ("8.0, 12.0", "8.0, 12.5")))
    ran = command("validate", table, "--config", moved)
    assert ran.code == 2
    assert "sensors.path_m is -4.5, 0, 4, 8, 12.5, 16, 22.5 there, in the table -4.5, 0, 4, 8, 12, 16" in ran.sentence
    ran = command("validate", table, "--config", config, "--log", "log.csv")
    assert ran.code == 2
    assert "whose passes are not logged; leave out --log" in ran.sentence


def test_explore_plays_the_passes_of_the_tune(
    command: Command, tuned_points: Path, config: Path, tmp_path: Path
) -> None:
    assert command("explore", tuned_points, "--config", config, "-o", tmp_path / "page").code == 0
    page = (tmp_path / "page" / "explore.html").read_text(encoding="utf-8")
    _, data = page.split('<script id="data" type="application/json">')
    (shown,) = (each["tables"] for each in json.loads(data.partition("</script>")[0])["classes"])
    cases = json.loads((tuned_points / "summary.json").read_bytes())["tables"]["cases"]
    for mine, case in zip(shown, cases, strict=True):
        assert mine["simulated"]["rms"][0] == case["rms_m_s"]["value"]
        assert mine["rule"] is None


def test_without_sensors_in_the_configuration_those_of_the_table_count(
    command: Command, tuned_points: Path, tmp_path: Path
) -> None:
    table, bare = tuned_points / "tables" / f"{TABLE}.json", tmp_path / "bare.toml"
    bare.write_text(changed(CONFIG, ("[sensors]\npath_m = [-4.5, 0.0, 4.0, 8.0, 12.0, 16.0, 22.5]\n", "")))
    _, found = validated(command, table, bare, tmp_path / "out")
    assert found["rms_m_s"]["value"] == pytest.approx(found["stated_rms_m_s"]["value"], rel=1e-12)
    bare.write_text(changed(bare.read_text(), ("mass_t = 22", "mass_t = 23")))
    ran = command("validate", table, "--config", bare)
    assert ran.code == 2
    assert "differs in cut.mass_t (23, in the table 22)" in ran.sentence


def test_inspect_tells_sensors_passages_and_switching_speeds(
    command: Command, tuned_points: Path, pages: list[Page]
) -> None:
    ran = command("inspect", tuned_points / "tables" / f"{TABLE}.json")
    table = read_json(tuned_points / "tables" / f"{TABLE}.json", PassageTable)
    assert ran.code == 0
    assert "7 at -4.5, 0, 4, 8, 12, 16, 22.5 m" in ran.out
    rows = [line.split() for line in ran.out.splitlines()]
    of_third = rows.index(["4.00", "2", "0", "0", *(f"{v:.3f}" for v in table.switching_m_s[2, 0, :3])])
    assert rows[of_third + 3] == ["3", *(f"{v:.3f}" for v in table.switching_m_s[2, 3, :3])]
    speeds = [list(row.values())[4:] for row in table_of(pages[-1])]
    wanted = table.switching_m_s[:, :4, :3].reshape(-1, 3)
    assert speeds == [[f"{v:.3f}" if np.isfinite(v) else "never" for v in row] for row in wanted]
    whole = command("inspect", tuned_points, "--json")
    document = json.loads(whole.out)
    assert [each["id"] for each in document["passage_tables"]] == ["gondola-4-22t-to-2-m-s", "gondola-4-22t-to-2.5-m-s"]
    assert "unchanged" in document["summary"]["sentence"]


def test_plot_draws_switching_speeds_and_passes_where_the_plant_is_known(
    command: Command, tuned_points: Path, config: Path, tmp_path: Path
) -> None:
    ran = command("inspect", tuned_points, "-o", tmp_path / "all", "--config", config)
    assert ran.code == 0, ran.err
    assert {path.name.removeprefix("gondola-4-22t-to-") for path in (tmp_path / "all").glob("*.svg")} == {
        "2-m-s-switching-speeds.svg", "2-m-s-passes.svg", "2.5-m-s-switching-speeds.svg", "2.5-m-s-passes.svg",
    }  # fmt: skip
    alone = tmp_path / "alone.json"
    alone.write_bytes((tuned_points / "tables" / f"{TABLE}.json").read_bytes())
    unknown = command("inspect", alone, "-o", tmp_path / "one")
    assert unknown.code == 0
    assert "no passes are drawn" in unknown.sentence
    assert set(results_in(tmp_path / "one")) == {
        f"{TABLE}-switching-speeds.svg", "report.html",
    }  # fmt: skip


def test_what_needs_lines_refuses_the_table_in_one_sentence(
    command: Command, tuned_points: Path, tmp_path: Path
) -> None:
    table = tuned_points / "tables" / f"{TABLE}.json"
    ran = command("sensitivity", "--table", table, "-o", tmp_path / "out")
    assert ran.code == 2
    assert "its tables are for point sensors; sensitivity --table takes tables for a radar" in ran.sentence


REFUSED = {
    "chance constraint": (("[grid]", f"[criterion]\np_overspeed = 0.1\n{MEASURED}[grid]"), "criterion.p_overspeed and"),
    "first sensor": (("[-4.5, 0.0", "[0.5, 1.0"), "sensors.path_m begins at 0.5; the first sensor must stand at"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_what_makes_no_tables_is_refused_before_anything_is_written(
    command: Command, name: str, tmp_path: Path
) -> None:
    swap, said = REFUSED[name]
    (tmp_path / "bad.toml").write_text(changed(CONFIG, swap))
    ran = command("tune", tmp_path / "bad.toml", "-o", tmp_path / "out")
    assert ran.code == 2
    assert said in ran.sentence
    assert not (tmp_path / "out").exists()


def test_an_infeasible_case_stands_outside_the_verdict(command: Command, config: Path, tmp_path: Path) -> None:
    """From 5.5 m/s the oiled brake cannot bring a full car to 2 m/s, whatever the table."""
    heavy = changed(
        CONFIG,
        ("mass_t = 22\nallowed_stage = 3\n", "mass_t = 80\n"),
        ("[2.0, 2.5]", "[2.0]"),
        ("[grid]", "[entry]\nlow_m_s = 5.0\nhigh_m_s = 5.5\n[grid]"),
        ("csv = true", "plots = false\nreport = false"),
    )
    (tmp_path / "heavy.toml").write_text(heavy)
    ran = command("tune", tmp_path / "heavy.toml", "-o", tmp_path / "out", "--json")
    assert ran.code == 1
    summary = json.loads(ran.out)
    (case,) = summary["tables"]["cases"]
    assert (case["verdict"], case["why_infeasible"]) == ("infeasible", "brake saturated")
    assert case["unavoidable_rms_m_s"]["low95"] > 0.15
    assert [limit["sentence"] for limit in summary["limits"]] == ["no case is feasible, so there is nothing to accept"]
    table = tmp_path / "out" / "tables" / f"{case['id']}.json"
    code, found = validated(command, table, tmp_path / "heavy.toml", tmp_path / "validated")
    assert (code, found["verdict"]) == (0, "infeasible")  # as the summary beside it says


def test_validate_takes_tables_of_both_kinds(command: Command, tuned_points: Path, tmp_path: Path) -> None:
    text = changed(
        CONFIG,
        ("exit_speeds_m_s = [2.0, 2.5]", "exit_speeds_m_s = [2.5]"),
        ("csv = true", "plots = false\nreport = false"),
    )
    (tmp_path / "one.toml").write_text(text)
    (tmp_path / "radar.toml").write_text(
        changed(text, ("[sensors]\npath_m = [-4.5, 0.0, 4.0, 8.0, 12.0, 16.0, 22.5]\n", ""))
    )
    assert command("tune", tmp_path / "radar.toml", "-o", tmp_path / "out").code in (0, 1)
    shutil.copy(tuned_points / "tables" / f"{TABLE}.json", tmp_path / "out" / "tables")
    command("validate", tmp_path / "out" / "tables", "--config", tmp_path / "one.toml", "-o", tmp_path / "again")
    found = json.loads((tmp_path / "again" / "summary.json").read_bytes())["tables"]["tables"]
    assert [each["id"] for each in found] == ["gondola-4-22t-to-2.5-m-s", TABLE]
    assert [each["confirmed"] for each in found] == [True, True]


def test_a_front_of_time_is_for_a_radar(command: Command, config: Path, tmp_path: Path) -> None:
    ran = command("tune", config, "--pareto", "-o", tmp_path / "out")
    assert (ran.code, ran.out) == (2, "")
    assert (
        ran.sentence == f"{config}: it has point sensors; --pareto is for tables for a radar: leave one of the two out"
    )


@pytest.mark.long
def test_the_checkers_own_passes_confirm_the_figures_and_only_true_ones(tuned_points: Path, tmp_path: Path) -> None:
    verdict = verify(tuned_points, 1500, 3)
    assert verdict.findings == ()
    for each in verdict.passages:
        assert each.figures is not None
        low, high = each.figures.rms_ci95_m_s
        assert low / 1.1 < each.table.predicted_rms_m_s < high * 1.1
        assert each.figures.switchings == pytest.approx(each.table.switchings, rel=0.05)
    forged = Path(shutil.copytree(tuned_points, tmp_path / "out"))

    def boast(document: dict[str, Any]) -> None:
        """Claim 0.7 of every rms."""
        for claim in (document["predicted"], document["validated"]):
            claim["rms_m_s"] *= 0.7
        document["validated"]["rms_ci95_m_s"] = [0.7 * end for end in document["validated"]["rms_ci95_m_s"]]

    rewrite(forged / "tables" / f"{TABLE}.json", boast)
    told = verify(forged, 1500, 3).findings
    assert {(each.kind, each.about) for each in told} >= {(Kind.CLAIM, TABLE), (Kind.DISAGREES, TABLE)}
    assert any("but the coarse simulation gives" in each.sentence for each in told)
