"""`explore`: the page of a tune, and what is refused."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from synth.retarder.explore import command as explore
from tests.system.conftest import CLASS, Command, changed
from tuning_tables import Decisions, read_json, to_json


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
