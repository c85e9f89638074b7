"""`loop` and `explore`: pictures, figures and pages of exported tables, and what is refused."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from synth.retarder.configuration.config_file import load_config
from synth.retarder.explore import command as explore
from tests.frame.small_command import results_in
from tests.printed_page import Page, table_of
from tests.synth.conftest import GONDOLA_OFFSETS_M
from tests.system.conftest import CLASS, Command, changed
from tuning_tables import Approach, CutId, Decisions, Generator, Predicted, RetarderId, read_json, to_json
from tuning_tables.json_file import write_json
from tuning_tables.passages.passage_row import PassageRow
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.sensor_layout import DecidesOn, PlausibleMotion, SensorLayout

pytest.importorskip("control")

TABLE = "gondola-4-22t-to-1.5-m-s"


@pytest.mark.long
def test_a_directory_gives_pictures_figures_and_a_table(
    command: Command, measured_once: Path, measured_classes: Path, tmp_path: Path, pages: list[Page]
) -> None:
    out = tmp_path / "loops"
    ran = command("loop", measured_once, "-o", out, "--config", measured_classes)
    assert ran.code == 0
    told = table_of(pages[-1])
    document = json.loads((out / "loops.json").read_bytes())
    assert [each["id"] for each in document["loops"]] == [TABLE, "gondola-4-30t-to-1.5-m-s"]
    names = {name.removeprefix("plots/") for name in results_in(out)}
    assert {f"{TABLE}-response.svg", f"{TABLE}-portrait.svg", f"{TABLE}-structure.svg"} <= names
    assert {"report.html", "summary.json", "sheets/loops.csv"} <= names
    for each in document["loops"]:
        assert each["difference"]["agrees"] is True
        assert abs(each["difference"]["largest_m_s"]) <= each["difference"]["tolerance_m_s"]
        row = next(row for row in told if row["table"] == each["id"])
        assert row["exit by python-control, m/s"] == f"{each['python_control']['exit_speed_m_s']:.4f}"
        assert row["exit by the simulator, m/s"] == f"{each['simulator']['exit_speed_m_s']:.4f}"
        assert row["largest difference, mm/s"].split()[0] == f"{1e3 * abs(each['difference']['largest_m_s']):.3f}"
        assert row["commands in a pass"] == str(len(each["python_control"]["commands"]))
        cycles = sum(name.startswith(f"{each['id']}-cycle") for name in names)
        assert cycles == len(each["limit_cycles"])
    assert "Python-control and the simulator agree where" in ran.out


def test_a_table_for_point_sensors_is_shown_too(command: Command, two_classes: Path, tmp_path: Path) -> None:
    """The class is found though a configuration knows no sensors; a table of another cut is refused by name."""
    table = tmp_path / "points.json"
    write_json(passage_table(two_classes), table)
    ran = command("loop", table, "-o", tmp_path / "out", "--config", two_classes, "--json")
    assert ran.code == 0, ran.err
    [row] = json.loads(ran.out)["tables"]["loops"]
    assert (row["id"], row["cycles"], row["forecast"]) == ("points", None, None)
    [found] = json.loads((tmp_path / "out" / "loops.json").read_bytes())["loops"]
    assert found["label"] == "gondola-4-22t"
    assert found["difference"]["agrees"] is True
    assert found["difference"]["parted_s"] is None
    assert found["simulator"]["commands"]
    heard = [each["sensor"] for each in found["simulator"]["readings"]]  # every axle is heard
    assert list(dict.fromkeys(heard)) == [0, 1, 2, 3]
    assert len(heard) > 4
    names = set(results_in(tmp_path / "out"))
    assert names == {
        *("configuration.toml", "loops.json", "report.html", "sheets/loops.csv", "summary.json"),
        *(f"plots/points-{name}.svg" for name in ("response", "structure")),
    }
    told = command("loop", table, "-o", tmp_path / "again", "--config", two_classes)
    assert told.code == 0
    changed = replace(passage_table(two_classes), cut=CutId("Л", 23.0, GONDOLA_OFFSETS_M, 1))
    write_json(changed, table)
    refused = command("loop", table, "-o", tmp_path / "no", "--config", two_classes)
    assert refused.code == 2
    assert "the nearest, gondola-4-22t, differs in cut.mass_t (22, in the table 23)" in refused.sentence


def braking_speed(left_m: float, stage: int) -> float:
    """From which speed on the stage above `stage` is wanted, so many metres before the exit: a float32 number."""
    return float(np.float32(math.sqrt(1.5**2 + 0.3 * (stage + 0.5) * left_m)))


def passage_table(config_path: Path) -> PassageTable:
    """Sensors around the position of the first class, and rows that brake the faster the cut."""
    _, plant = load_config(config_path).plants()[0]
    sensors = SensorLayout((-3.0, 2.0, 6.0, 12.0), 0.2, 0.002, 1e-4, 1e-4, 0.02, 0.02, DecidesOn.FIRST_AXLE)
    offsets, top = plant.cut.axle_offsets_m, plant.top_stage
    position = plant.position
    passages = tuple(
        PassageRow(*met, (tuple(braking_speed(plant.exit_m - max(met[2], 0.0), j) for j in range(top)),) * (top + 1))
        for met in sensors.passages(offsets, plant.exit_m)
    )
    return PassageTable(
        id="points",
        created="2026-11-22T22:46:00Z",
        generator=Generator("retarder-synth", "0.1.0", "0123456789abcdef" * 4),
        retarder=RetarderId(position.name, position.zones_m, plant.exit_m, position.pneumatics.dead_band_kpa),
        cut=CutId(plant.cut.category, plant.cut.mass_t, offsets, plant.cut.category_number),
        target_speed_m_s=1.5,
        pressure_kpa=position.stage_pressures_kpa[: top + 1],
        sensors=sensors,
        approach=Approach(3.0, top),
        initial_stage=0,
        passages=passages,
        plausible=PlausibleMotion((0.1, 15.0), 0.5, 3.0, 0.05, 0.3),
        valid_v_m_s=(0.5, 9.0),
        predicted=Predicted(0.08, -0.001, 0.01, 3.1, 0.0),
    )


def test_responses_that_do_not_agree_give_1(
    command: Command, tuned: Path, two_classes: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("synth.retarder.loops.control_loop.TOLERANCE_M_S", 1e-9)
    ran = command("loop", tuned / "tables" / f"{TABLE}.json", "-o", tmp_path / "out", "--config", two_classes)
    assert ran.code == 1
    assert "not accepted" in ran.out
    assert "python-control and the simulator do not agree" in ran.out


def test_bad_input_is_one_sentence(command: Command, tuned: Path, tmp_path: Path) -> None:
    table = tmp_path / "alone.json"
    table.write_bytes((tuned / "tables" / f"{TABLE}.json").read_bytes())
    refused = command("loop", table, "-o", tmp_path / "out")  # the built-in plant is another
    assert refused.code == 2
    assert "no cut class fits the table" in refused.sentence
    assert not (tmp_path / "out").exists()
    missing = command("loop", tmp_path / "nowhere.json")
    assert (missing.code, "there is no such file" in missing.sentence) == (2, True)
    (tmp_path / "empty").mkdir()
    assert command("loop", tmp_path / "empty").code == 2
    table.write_bytes(table.read_bytes().replace(b'"degree": 2', b'"degree": 3'))
    assert command("loop", table).code == 3


def test_help_loads_no_control_library() -> None:
    program = "import sys; from synth.cli import main; main(['loop', '--help']); print(*sys.modules, file=sys.stderr)"
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=True)
    assert {"control", "numba", "scipy", "matplotlib"}.isdisjoint(ran.stderr.split())


@pytest.fixture
def book(tuned_once: tuple[Path, int]) -> Path:
    """Two tables."""
    return tuned_once[0]


def test_a_book_becomes_one_page(command: Command, book: Path, two_classes: Path, tmp_path: Path) -> None:
    ran = command("explore", book, "--config", two_classes, "-o", tmp_path / "page")
    assert ran.code == 0
    assert "explore.html: 2 tables brake cuts in the browser" in ran.out
    page = (tmp_path / "page" / "explore.html").read_text(encoding="utf-8")
    _, data = page.split('<script id="data" type="application/json">')
    classes = json.loads(data.partition("</script>")[0])["classes"]
    assert [len(each["tables"]) for each in classes] == [1, 1]
    assert [each["plant"]["mass_t"] for each in classes] == [22.0, 30.0]
    assert classes[0]["plant"]["mass_limits_t"][0] >= 20.0
    assert "the plant may differ" not in page
    cases = json.loads((book / "summary.json").read_bytes())["tables"]["cases"]
    for case, (shown,) in zip(cases, (each["tables"] for each in classes), strict=True):
        assert shown["simulated"]["rms"][0] == case["rms_m_s"]["value"]
        assert shown["rule"]["name"] == case["best_baseline"]
        assert shown["rule"]["simulated"]["rms"][0] == case["best_baseline_m_s"]["value"]
    assert 'href="explore.html"' in (tmp_path / "page" / "report.html").read_text(encoding="utf-8")


def test_a_plant_that_may_be_another_is_told_on_the_page(
    command: Command, book: Path, two_classes: Path, tmp_path: Path
) -> None:
    config = tmp_path / "other.toml"
    config.write_text(two_classes.read_text() + "[sensor]\nnoise_m_s = 0.06\n")
    ran = command("explore", book, "--config", config, "-o", tmp_path / "page")
    assert ran.code == 0
    page = (tmp_path / "page" / "explore.html").read_text(encoding="utf-8")
    assert "tables were made from another configuration than " in page


def test_the_same_book_gives_the_same_bytes(command: Command, book: Path, two_classes: Path, tmp_path: Path) -> None:
    for name in ("one", "other"):
        assert command("explore", book, "--config", two_classes, "-o", tmp_path / name).code == 0
    one, other = ((tmp_path / name / "explore.html").read_bytes() for name in ("one", "other"))
    assert one == other


def test_tables_without_a_plant_are_refused(command: Command, book: Path, tmp_path: Path) -> None:
    config = tmp_path / "other.toml"
    config.write_text(changed(CLASS, ("mass_t = 22", "mass_t = 25")))
    ran = command("explore", book, "--config", config, "-o", tmp_path / "page")
    assert ran.code == 2
    assert "no cut class fits the table" in ran.sentence
    assert not (tmp_path / "page" / "explore.html").exists()


def test_a_table_at_any_time_on_a_drive_that_is_not_modelled_so_is_refused(
    command: Command, tuned_once: tuple[Path, int], tmp_path: Path
) -> None:
    (file,) = (tuned_once[0] / "tables").glob("*22t*.json")
    table = read_json(file)
    any_time = tmp_path / "any-time.json"
    any_time.write_bytes(to_json(replace(table, decisions=Decisions.AT_ANY_TIME)))
    config = tmp_path / "late.toml"
    config.write_text(CLASS + "[sensor]\ncomputing_delay_s = 0.2\n")
    ran = command("explore", any_time, "--config", config, "-o", tmp_path / "page")
    assert ran.code == 2
    assert "computing_delay_s is 0.2; commands at every sample are modelled for delays shorter than" in ran.sentence


def test_a_page_that_is_too_large_is_refused(
    command: Command, book: Path, two_classes: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(explore, "LARGEST_PAGE_BYTES", 50_000)
    ran = command("explore", book, "--config", two_classes, "-o", tmp_path / "page")
    assert ran.code == 2
    assert "a page of its 2 tables could have 0.2 MB; 0.05 MB are allowed" in ran.sentence


def test_a_place_without_tables_is_refused(command: Command, tmp_path: Path) -> None:
    ran = command("explore", tmp_path / "none.h5", "-o", tmp_path / "page")
    assert ran.code == 2
    assert "there is no such file" in ran.sentence
