"""The example with types of one's own: tuned, told by its own names everywhere, verified, and run in C."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from scripts.studies.in_the_loop.agreement import ask, differences, follow
from scripts.studies.in_the_loop.controller_process import build_controller
from synth.cli import main
from tests.controller_code.conftest import tool as tool
from tests.system.conftest import EPOCH, Command
from tuning_tables import TableBook, read_book

EXAMPLE = Path(__file__).parents[2] / "docs" / "examples" / "us-group"
COARSE = """
[grid]
path_step_m = 1.0
speed_step_m_s = 0.05
friction_scenarios = 3
resistance_scenarios = 1
[validation]
passes = 1000
[acceptance]
rms_m_s = 0.3
prediction_ratio_low = 0.5
prediction_ratio_high = 2.0
p_overspeed = 0.5
p_stall = 0.5
[output]
plots = false
"""


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the example on a coarse grid, tuned into out/."""
    folder = tmp_path_factory.mktemp("own") / "us-group"
    shutil.copytree(EXAMPLE, folder)
    config = folder / "us-group.toml"
    config.write_text(config.read_text(encoding="utf-8") + COARSE, encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", EPOCH)
        assert main(["tune", str(config), "-o", str(folder / "out"), "--workers", "2"]) == 0
    return folder


@pytest.fixture(scope="module")
def book(example: Path) -> TableBook:
    """Its tables."""
    return TableBook(tuple(read_book(example / "out" / "book.h5")))


def test_classes_have_their_own_targets_masses_axles_and_category_numbers(book: TableBook) -> None:
    found = {
        t.id: (t.cut.category, t.cut.category_number, t.cut.mass_t, len(t.cut.axle_offsets_m)) for t in book.tables
    }
    assert found == {
        "well-5-empty-to-2.5-m-s": ("US-L", 16, 90.0, 12),
        "well-5-empty-to-3.5-m-s": ("US-L", 16, 90.0, 12),
        "wagon-2-to-3-m-s": ("US-M", 17, 30.0, 2),
        "gondola-286k-full-to-3-m-s": ("US-H", 18, 129.7, 4),
        "gondola-286k-full-to-3.5-m-s": ("US-H", 18, 129.7, 4),
        "full-and-empty-to-3.5-m-s": ("US-M", 17, 159.7, 8),
    }
    assert {t.retarder.name for t in book.tables} == {"us-group-1"}
    assert {len(t.retarder.zones_m) for t in book.tables} == {3}
    assert {len(t.stages) for t in book.tables} == {5}
    (well, *_) = book.tables
    assert well.cut.axle_offsets_m[-1] == 76.6 + 1.78
    assert well.retarder.exit_m == pytest.approx(31.1 + 78.38)


def test_axles_of_a_mixed_cut_follow_from_lengths_and_overhangs(book: TableBook) -> None:
    """Front gondola: 16.18 m with 14.12 m of axles; each wagon: 15.5 m with 9 m."""
    offsets = next(t.cut.axle_offsets_m for t in book.tables if t.id.startswith("full-and-empty"))
    first_wagon = (16.18 - 14.12) / 2 + 14.12 + (15.5 - 9.0) / 2
    np.testing.assert_allclose(offsets[4:6], (first_wagon, first_wagon + 9.0))
    np.testing.assert_allclose(offsets[6:8], (first_wagon + 15.5, first_wagon + 24.5))


def test_every_artefact_bears_the_users_names_and_none_of_the_library(example: Path) -> None:
    out = example / "out"
    for file in (*out.glob("tables/*.json"), *out.glob("c/*"), out / "report.html", out / "summary.json"):
        text = file.read_text(encoding="utf-8")
        assert "knp-5" not in text, file
        assert "us-group-1" in text or file.suffix in (".csv", ".c", ".h"), file
    header = (out / "c" / "retarder_table.h").read_text(encoding="utf-8")
    for line in ("RETARDER_CATEGORY_US_L 16 ", "RETARDER_CATEGORY_US_M 17 ", "RETARDER_CATEGORY_US_H 18 "):
        assert line in header
    report = (out / "report.html").read_text(encoding="utf-8")
    assert "(types/retarders/us-group.toml)" in report


def test_the_tables_validate_against_the_configuration_with_own_types(
    example: Path, command: Command, tmp_path: Path
) -> None:
    config = example / "us-group.toml"
    ran = command(
        "validate", example / "out" / "book.h5", "--config", config, "--passes", "1000", "--json", "-o", tmp_path
    )
    found = json.loads(ran.out)["tables"]["tables"]
    assert len(found) == 6
    assert all(each["same_config"] for each in found)


def test_compiled_c_decides_and_chooses_as_python(book: TableBook, tmp_path: Path, tool: Callable[[str], str]) -> None:
    tool("gcc")
    questions = ask(book, 20_000, 2_000, 20261122)
    assert differences(build_controller(book, tmp_path), questions, follow(book, 1_000, 20261122)).none


def test_init_prints_every_kind_of_type(command: Command, tmp_path: Path) -> None:
    """With a name, without one, and what cannot be."""
    for word, name in (("car", "tank-8"), ("retarder", "t-50"), ("position", "kv-3-bunch")):
        assert command("init", word, name).out.count(f" {name} of the library") == 1
        assert f"my-types/{word}s/my-" in command("init", word).out
    assert (
        json.loads(command("init", "sensor", "--json").out)["text"] == command("init", "sensor").out.rstrip("\n") + "\n"
    )
    assert "number = 5" in command("init", "weight-categories").out
    assert "did you mean gondola-4?" in command("init", "car", "gondola").sentence
    assert command("init", "cars").sentence == "init cars: there is no such kind of file; did you mean car?"
    assert set(json.loads(command("init", "--list", "--json").out)["library"]) == {
        "positions", "retarders", "cars", "sensors", "wheel_sensors", "weight_categories", "tracks", "car_mixes",
        "humps",
    }  # fmt: skip
