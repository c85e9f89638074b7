"""The commands tune, inspect, plot and init on a real, small book: exit codes, what is printed, what is written."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

import pytest

from synth.retarder.configuration.config_file import parse_config
from tests.frame.small_command import results_in
from tests.system.conftest import CLASS, Command, changed
from tests.system.small_book import C_FILES, HEAVIER, ID
from tuning_tables import read_book, read_json, to_csv


def summary_of(directory: Path) -> dict[str, Any]:
    summary: dict[str, Any] = json.loads((directory / "summary.json").read_bytes())
    return summary


def test_tune_leaves_what_the_contract_says(tuned_once: tuple[Path, int]) -> None:
    directory, code = tuned_once
    assert code == 0
    files = set(results_in(directory))
    assert {"book.h5", "report.html", "summary.json", f"tables/{ID}.json", f"tables/{ID}.csv"} <= files
    assert {"plots/rms-by-controller.svg", "plots/feasibility.svg"} <= files
    assert {path.name for path in (directory / "c").iterdir()} == C_FILES
    summary = summary_of(directory)
    assert set(summary["files"]) == files - {"summary.json"}
    for name, digest in summary["files"].items():
        assert hashlib.sha256((directory / name).read_bytes()).hexdigest() == digest
    assert {t.cut.category: t.cut.category_number for t in read_book(directory / "book.h5")} == {"Л": 1, "ЛС": 2}
    assert read_json(directory / "tables" / f"{ID}.json").cut.category_number == 1


def test_the_summary_tells_the_figures_of_the_tables(tuned_once: tuple[Path, int], two_classes: Path) -> None:
    directory, _ = tuned_once
    summary = summary_of(directory)
    assert (summary["format"], summary["command"], summary["accepted"]) == ("retarder-synth-summary", "tune", True)
    assert summary["created"] == "2023-11-14T22:13:20Z"
    assert summary["generator"]["config_sha256"] == parse_config(two_classes.read_text(), "two.toml").sha256
    tables = read_book(directory / "book.h5")
    rows = summary["tables"]
    assert [case["id"] for case in rows["cases"]] == [table.id for table in tables] == [ID, HEAVIER]
    known = [row for row in rows["controllers"] if row["controller"] == "friction known"]
    for case, table, bound in zip(rows["cases"], tables, known, strict=True):
        assert read_json(directory / "tables" / f"{case['id']}.json") == table
        assert to_csv(table) == (directory / "tables" / f"{table.id}.csv").read_bytes()
        assert table.validated is not None
        low, high = table.validated.rms_ci95_m_s
        n = table.validated.passes
        assert case["rms_m_s"] == {"value": table.validated.rms_m_s, "low95": low, "high95": high, "n": n}
        assert case["predicted_rms_m_s"] == pytest.approx(table.predicted.rms_m_s)
        assert case["prediction_ratio"]["value"] == pytest.approx(table.predicted.rms_m_s / table.validated.rms_m_s)
        assert case["regret"]["value"] == pytest.approx(table.validated.rms_m_s / bound["rms_m_s"]["value"])
        assert case["best_baseline"] in {row["controller"] for row in rows["controllers"]}
        assert case["verdict"] == "accepted"


def test_tune_prints_a_table_and_where_things_are(command: Command, one_class: Path, tmp_path: Path) -> None:
    plain = one_class.with_name("plain.toml")
    plain.write_text(CLASS.replace("csv = true", "plots = false\nreport = false"))
    ran = command("tune", plain, "-o", tmp_path / "out")
    assert ran.code == 0
    assert "gondola-4-22t" in ran.out
    assert "accepted: the limits are kept in 1 feasible case" in ran.out
    assert f"{tmp_path / 'out'}: c/, sheets/, tables/, book.h5, configuration.toml, summary.json" in ran.out
    assert "report" not in ran.out
    assert "[1/1] gondola-4-22t to 1.5 m/s: rms 0.0" in ran.err
    files = {name for name in summary_of(tmp_path / "out")["files"] if not name.startswith("sheets/")}
    assert files == {"book.h5", "configuration.toml", *(f"c/{name}" for name in C_FILES), f"tables/{ID}.json"}


@pytest.mark.requirement("CMD-03")
def test_missed_limits_give_1_and_stale_files_go(command: Command, one_class: Path, tuned: Path) -> None:
    strict = one_class.with_name("strict.toml")
    strict.write_text(
        changed(
            CLASS, ("csv = true", "plots = false\nreport = false"), ("prediction_ratio_high = 1.35", "rms_m_s = 0.01")
        )
    )
    (tuned / "tables" / "my-notes.json").write_text("{}")
    (tuned / "plots" / "my-photo.png").write_bytes(b"photo")
    leftover = tuned / "tables" / f".{HEAVIER}.json.{'0' * 16}.part"
    leftover.write_text("half")
    ran = command("tune", strict, "-o", tuned, "--json")
    assert ran.code == 1
    summary = json.loads(ran.out)
    assert summary == summary_of(tuned)
    assert (summary["accepted"], summary["tables"]["cases"][0]["verdict"]) == (False, "missed")
    (limit,) = summary["limits"]
    assert limit["kept"] is False
    assert "gondola-4-22t, target 1.5 m/s: rms 0.0" in limit["sentence"]
    assert sorted(path.name for path in tuned.glob("tables/*")) == [f"{ID}.json", "my-notes.json"]
    assert [path.name for path in tuned.glob("plots/*")] == ["my-photo.png"]
    assert not (tuned / "report.html").exists()
    assert not leftover.exists()


def test_an_infeasible_book_is_not_accepted(command: Command, one_class: Path, tmp_path: Path) -> None:
    hopeless = one_class.with_name("hopeless.toml")
    hopeless.write_text(CLASS.replace("high_m_s = 4.0", "high_m_s = 5.5").replace("csv = true", "plots = false"))
    ran = command("tune", hopeless, "-o", tmp_path)
    assert ran.code == 1
    assert "gondola-4-22t, target 1.5 m/s, brake saturated: entry speeds from 1.51 to" in ran.out
    assert "no case is feasible" in ran.out
    again = command("validate", tmp_path / "book.h5", "--config", hopeless, "-o", tmp_path / "again")
    assert again.code == 0  # known to be infeasible, from the summary beside it
    assert "summary.json beside the tables calls this case infeasible" in again.out
    (tmp_path / "summary.json").unlink()
    assert command("validate", tmp_path / "book.h5", "--config", hopeless, "-o", tmp_path / "again").code == 1


def test_inspect_tells_the_contents(command: Command, tuned: Path) -> None:
    ran = command("inspect", tuned)
    assert ran.code == 0
    assert f"{ID}: leave with 1.5 m/s" in ran.out
    assert "stage 1 (150 kPa) down below" in ran.out
    assert "its CRC-32 is right" in ran.out
    assert "that it lists are there unchanged" in ran.out
    found = json.loads(command("inspect", tuned / "book.h5", "--json").out)
    assert [table["id"] for table in found["files"][0]["tables"]] == [ID, HEAVIER]
    assert found["files"][0]["tables"][0]["lines_at"][0]["k"] == 0


def test_inspect_finds_a_file_that_does_not_belong(command: Command, tuned: Path) -> None:
    (tuned / "report.html").write_text("another")
    ran = command("inspect", tuned)
    assert ran.code == 3
    assert "report.html: its SHA-256 is not the one in summary.json" in ran.sentence


def test_plot_draws_without_solving(command: Command, tuned: Path, two_classes: Path, tmp_path: Path) -> None:
    ran = command("inspect", tuned, "-o", tmp_path / "plots", "--config", two_classes, "--json")
    assert ran.code == 0
    names = {Path(name).name for name in json.loads(ran.out)["pictures"]}
    kinds = ("lines", "surfaces", "passes")
    assert names == {f"{i}-{kind}.svg" for i in (ID, HEAVIER) for kind in kinds}
    assert names | {"report.html"} == set(results_in(tmp_path / "plots"))
    alone = tmp_path / "alone.json"
    alone.write_bytes((tuned / "tables" / f"{ID}.json").read_bytes())
    without = command("inspect", alone, "-o", tmp_path / "bare")
    assert without.code == 0
    assert "no passes are drawn" in without.sentence
    assert len(results_in(tmp_path / "bare")) == 3


def test_init_prints_what_tune_reads(command: Command) -> None:
    ran = command("init", "configuration", "t-50-bunch")
    assert ran.code == 0
    assert parse_config(ran.out, "out").retarder.name == "t-50-bunch"
    assert json.loads(command("init", "--json").out)["text"] == command("init").out
    assert "knp-5-bunch" in command("init", "--list").out
    assert "did you mean t-50-bunch?" in command("init", "configuration", "t-50-bu").sentence


def test_init_prints_a_configuration_with_point_sensors(command: Command) -> None:
    bare, named = command("init", "point-sensors"), command("init", "point-sensors", "knp-5-bunch")
    assert [parse_config(ran.out, "out").retarder.name for ran in (bare, named)] == ["rnz-2m-dumper", "knp-5-bunch"]
    assert command("init", "wheel-sensor").out.splitlines()[1].startswith("# A wheel sensor of retarder-synth")
    assert "did you mean knp-5-bunch?" in command("init", "point-sensors", "knp-5").sentence
