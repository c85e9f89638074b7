"""validate, tables that act before the entrance, and another criterion, as a user runs them."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.controller_code.sample_book import FOUR_AXLES, table_of, with_approach
from tests.system.conftest import CLASS, EPOCH, MEASURED, Command
from tests.system.small_book import ID
from tuning_tables import read_book, read_json, to_json, write_json
from tuning_tables.json_text import canonical_json, document_checksum
from tuning_tables.pass_log.log_files import read_logs


def test_validate_confirms_what_the_tables_say(
    command: Command, tuned: Path, two_classes: Path, tmp_path: Path
) -> None:
    ran = command("validate", tuned / "book.h5", "--config", two_classes, "--json", "-o", tmp_path / "one")
    assert ran.code == 0
    found = json.loads(ran.out)
    assert (found["warnings"], found["accepted"]) == ([], True)
    for each, table in zip(found["tables"]["tables"], read_book(tuned / "book.h5"), strict=True):
        assert table.validated is not None
        assert each["rms_m_s"]["value"] == table.validated.rms_m_s  # the same passes
        assert each["stated_rms_m_s"] == each["rms_m_s"]
        assert (each["confirmed"], each["same_config"]) == (True, True)
    page = (tmp_path / "one" / "report.html").read_text(encoding="utf-8").partition("<h2>")[0]
    n = len(found["tables"]["tables"])
    assert f"<strong>{n} of {n}</strong><p>files state an rms that these passes confirm</p>" in page
    assert "What to do first" not in page
    given = ("validate", tuned / "tables" / f"{ID}.json", "--config", two_classes, "-o", tmp_path / "other")
    other = command(*given, "--seed", 7, "--passes", 4000)
    assert other.code == 0
    assert "limits kept, as stated" in other.out
    assert "4000 stratified passes of each table, seed 7" in other.out


@pytest.mark.parametrize(("name", "std"), [("log.csv", "0"), ("log.h5", "none")])
def test_validate_logs_passes_as_a_controller_would(
    command: Command, tuned: Path, two_classes: Path, tmp_path: Path, name: str, std: str
) -> None:
    given = ("validate", tuned / "book.h5", "--config", two_classes, "--passes", 1000, "--log", name, "-o", tmp_path)
    ran = command(*given, "--log-passes", 30, "--gauge-std", std)
    assert ran.code == 0
    assert f"30 passes of each table, as a controller logs them: {name}" in ran.out
    tables = read_book(tuned / "book.h5")
    loaded = read_logs([tmp_path / name], None, len(tables[0].stages) - 1)
    assert loaded.faults == ()
    log = loaded.log
    assert Counter(log.mass_t.tolist()) == {22.0: 30, 30.0: 30}
    assert set(log.target_m_s) == {1.5}
    assert log.has_gauge == (std == "0")
    if log.has_gauge:  # a drive at rest is within the dead band of its stage, and an exact gauge shows it there
        apart_kpa = np.abs(log.pressure_kpa - np.array([stage.pressure_kpa for stage in tables[0].stages])[log.stage])
        assert np.median(apart_kpa) <= tables[0].retarder.dead_band_kpa


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--log", "log.xlsx"), "--log is 'log.xlsx'; it must be the name of a file in DIR that ends in .csv or .h5"),
        (("--log", "a/log.csv"), "--log is 'a/log.csv'; it must be the name of a file in DIR"),
        (("--log-passes", 5), "are about a log; name its file in DIR by --log NAME.csv"),
        (("--gauge-std", "none"), "are about a log; name its file in DIR by --log NAME.csv"),
        *(
            (("--log", "log.csv", "--gauge-std", word), f"--gauge-std is '{word}'; it must be 0 to 100 kPa, or none")
            for word in ("-1", "nan", "101", "much")
        ),
    ],
)
def test_validate_refuses_a_log_that_cannot_be(
    command: Command, tuned: Path, tmp_path: Path, words: tuple[object, ...], says: str
) -> None:
    ran = command("validate", tuned / "book.h5", *words, "-o", tmp_path / "out")
    assert (ran.code, ran.out) == (2, "")
    assert says in ran.sentence
    assert not (tmp_path / "out").exists()


@pytest.mark.requirement("CMD-10")
def test_validate_finds_a_table_that_lies(command: Command, tuned: Path, two_classes: Path, tmp_path: Path) -> None:
    path = tuned / "tables" / f"{ID}.json"
    table = read_json(path)
    text = to_json(table).decode().replace(f'"rms_m_s": {table.predicted.rms_m_s!r}', '"rms_m_s": 0.005')
    document = json.loads(text)
    document.pop("crc32")
    document["crc32"] = document_checksum(document)
    path.write_bytes(canonical_json(document))
    ran = command("validate", path, "--config", two_classes, "-o", tmp_path / "out")
    assert ran.code == 1
    assert "predicted / simulated rms 0.2" in ran.out


def test_validate_refuses_a_plant_that_does_not_fit(command: Command, tuned: Path, tmp_path: Path) -> None:
    beside = command("validate", tuned / "book.h5", "--passes", "1000", "-o", tmp_path / "beside", "-q")
    assert beside.code == 0  # by the configuration that lies beside the book
    assert beside.out.startswith("accepted: ")
    assert (beside.err, beside.out.count("\n")) == ("", 1)
    (tmp_path / "alone.h5").write_bytes((tuned / "book.h5").read_bytes())
    ran = command("validate", tmp_path / "alone.h5", "-o", tmp_path / "out")
    assert ran.code == 2
    assert "no cut class fits the table gondola-4-22t-to-1.5-m-s" in ran.sentence
    assert "retarder.zones_m" in ran.sentence


def test_inspect_tells_the_approach_and_its_interlock(command: Command, tmp_path: Path) -> None:
    plain = table_of("one", "Л", 23.0, FOUR_AXLES, 2.0)
    write_json(plain, tmp_path / "plain.json")
    write_json(with_approach(plain, 4.0, 1), tmp_path / "approached.json")
    told = command("inspect", tmp_path / "approached.json").out
    assert "acts from 4 m before the entrance on, where it commands no stage above 1;" in told
    assert "only when the cut ahead has left the position" in told
    assert "path -4 to 37.45 m" in told
    assert "approach" not in command("inspect", tmp_path / "plain.json").out.replace("approached.json", "")
    as_json = json.loads(command("inspect", tmp_path / "approached.json", "--json").out)
    (table,) = as_json["files"][0]["tables"]
    assert table["approach"] == {"length_m": 4.0, "entrance_stage": 1, "interlock": "position_clear"}
    assert table["lines_at"][0]["v_m_s"]


def test_every_form_of_export_holds_it(command: Command, tmp_path: Path) -> None:
    write_json(with_approach(table_of("one", "Л", 23.0, FOUR_AXLES, 2.0), 4.0, 1), tmp_path / "one.json")
    for form, name, words in (
        ("csv", "one.csv", "number,approach.entrance_stage,1"),
        ("csv", "one.csv", "text,approach.interlock,position_clear"),
        ("c", "retarder_table.c", "1, /* entrance_stage */"),
        ("st", "retarder_table.st", "EntranceStageOf"),
        ("json", "one.json", '"interlock": "position_clear"'),
    ):
        run = command("export", tmp_path / "one.json", "--format", form, "-o", tmp_path / form)
        assert run.code == 0, run.err
        (written,) = (tmp_path / form).rglob(name)
        assert words in written.read_text(encoding="utf-8")


def test_a_table_of_before_is_told_which_key_it_needs(
    command: Command, tuned: Path, two_classes: Path, tmp_path: Path
) -> None:
    assert "approach_m" not in two_classes.read_text(encoding="utf-8")
    table = read_json(tuned / "tables" / "gondola-4-22t-to-1.5-m-s.json")
    path, config = tmp_path / "before.json", tmp_path / "with_the_key.toml"
    write_json(replace(table, approach=None, valid=replace(table.valid, s_m=(0.0, table.valid.s_m[1]))), path)
    ran = command("validate", path, "--config", two_classes, "--passes", "1000", "-o", tmp_path / "out")
    assert ran.code == 2
    assert "differs in regulator.approach_m (4, in the table 0)" in ran.sentence
    assert ran.sentence.endswith("by --config, with regulator.approach_m = 0 in it if it names none")
    config.write_text(two_classes.read_text(encoding="utf-8") + "[regulator]\napproach_m = 0.0\n", encoding="utf-8")
    assert "rms" in command("validate", path, "--config", config, "--passes", "1000", "-o", tmp_path / "out").out


def test_an_approach_that_makes_every_cut_faster_is_one_sentence(
    command: Command, two_classes: Path, tmp_path: Path
) -> None:
    config, steep = tmp_path / "steep.toml", "[regulator]\napproach_m = 100.0\n[track]\ngrade_permille = 30.0\n"
    config.write_text(two_classes.read_text(encoding="utf-8") + steep, encoding="utf-8")
    ran = command("tune", config, "-o", tmp_path / "out")
    assert ran.code == 2
    assert "steep.toml: regulator.approach_m is 100; there the grade alone brings each cut to 7." in ran.sentence
    assert ran.sentence.endswith("raise that speed (cut class gondola-4-22t)")


def test_a_wrong_initial_stage_names_the_class_that_forbids_it(
    command: Command, two_classes: Path, tmp_path: Path
) -> None:
    config, classes = tmp_path / "closed.toml", two_classes.read_text(encoding="utf-8") + "entrance_stage = 1\n"
    for stage, told in (
        (2, "from 0 to the stage allowed at the entrance, 1 (cut class gondola-4-30t)"),
        (-1, "from 0 to 31"),
    ):
        config.write_text(f"{classes}[regulator]\ninitial_stage = {stage}\n", encoding="utf-8")
        ran = command("tune", config, "-o", tmp_path / "out")
        assert ran.code == 2
        assert ran.sentence.endswith(f"regulator.initial_stage is {stage}; it must be a whole number {told}")


@pytest.fixture
def default_case(measured_once: Path) -> Any:
    """The case of the default criterion in its summary."""
    summary = json.loads((measured_once / "summary.json").read_text())
    assert summary["figures"]["criterion"] == "mean squared exit-speed error"
    assert "requirement" not in summary["tables"]
    return summary["tables"]["cases"][0]


def tuned_by(command: Command, criterion: str, out: Path) -> tuple[Any, str]:
    """(summary, report) of a tune for the measured speed with that [criterion]."""
    config = out.with_suffix(".toml")
    config.write_text(CLASS.replace("csv = true", "plots = false") + MEASURED + f"[criterion]\n{criterion}\n")
    assert command("tune", config, "-o", out, "--workers", "1").code in (0, 1)
    return json.loads((out / "summary.json").read_text()), (out / "report.html").read_text()


def test_dearer_overspeed_makes_slower_exits(command: Command, default_case: Any, tmp_path: Path) -> None:
    summary, report = tuned_by(command, "overspeed_factor = 4.0", tmp_path / "out")
    assert "over-speed weighing 4 times" in summary["figures"]["criterion"]
    assert summary["figures"]["criterion"] in report
    (slower,) = summary["tables"]["cases"]
    assert slower["bias_m_s"]["value"] < default_case["bias_m_s"]["value"] - 0.003


def test_a_limit_that_is_kept_anyway_changes_no_line(
    command: Command,
    default_case: Any,
    measured_once: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", EPOCH)
    summary, report = tuned_by(command, "p_overspeed = 0.5\noverspeed_margin_m_s = 0.3", tmp_path / "out")
    (case,), (requirement,) = summary["tables"]["cases"], summary["tables"]["requirement"]
    assert requirement["multiplier_m2_s2"] == 0.0
    assert "without a price and keeps 0.5: the limit is not active" in report
    predicted = [
        {key: value for key, value in each.items() if key.startswith("predicted_")} for each in (case, default_case)
    ]
    assert predicted[0] == predicted[1]
    assert predicted[0]["predicted_rms_m_s"] > 0.0
    tables = [
        json.loads((at / "tables" / f"{case['id']}.json").read_text()) for at in (tmp_path / "out", measured_once)
    ]
    assert tables[0]["stages"] == tables[1]["stages"]
    assert tables[0]["generator"]["config_sha256"] != tables[1]["generator"]["config_sha256"]
