"""`aim` from the command line to its last file, and on configurations of one's own: closed form, steep tracks,
refusals.
"""

from __future__ import annotations

import hashlib
import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from synth.cli import main
from tests.frame.small_command import results_in
from tests.system.conftest import EPOCH, Command
from tuning_tables.aim import aim_exit_speed
from tuning_tables.aim.aim_tables import AimTable
from tuning_tables.json_file import read_json

SMALL = """\
[cuts]
categories = ["L", "T"]
cars = [1, 3]
[aim]
free_distances_m = [50.0, 100.0, 200.0]
[simulation]
passes = 2000
"""


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A configuration of two categories, two numbers of cars and three distances."""
    path = tmp_path_factory.mktemp("aim") / "small.toml"
    path.write_text(SMALL, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def aimed_once(small: Path) -> tuple[Path, int]:
    """(directory, exit code) of an aim; not to be changed."""
    directory = small.with_name("out")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", EPOCH)
        code = main(["aim", str(small), "-o", str(directory)])
    return directory, code


@pytest.fixture
def aimed(aimed_once: tuple[Path, int], tmp_path: Path) -> Path:
    """A copy of the directory, to be changed at will."""
    return Path(shutil.copytree(aimed_once[0], tmp_path / "aimed"))


def files_in(directory: Path) -> dict[str, bytes]:
    """The content of every file by its relative name."""
    return results_in(directory)


def test_aim_leaves_tables_code_pictures_report_and_a_summary_of_them(aimed_once: tuple[Path, int]) -> None:
    directory, code = aimed_once
    assert code == 0
    files, summary = files_in(directory), json.loads((directory / "summary.json").read_bytes())
    assert set(files) - {"summary.json"} == set(summary["files"])
    ids = [f"rnz-2m-park-{category}-{known}" for category in ("L", "T") for known in ("category", "measured")]
    assert [table["id"] for table in summary["tables"]["aim-tables"]] == ids
    assert {f"tables/{name}.{form}" for name in ids for form in ("json", "csv")} <= set(files)
    assert {"c/aim_table.c", "c/aim_table.h", "st/aim_table.st", "plots/aim-track.svg", "report.html"} <= set(files)
    assert (summary["command"], summary["accepted"], summary["created"]) == ("aim", True, "2023-11-14T22:13:20Z")
    page = files["report.html"].decode()
    for words in ("Accepted", "assumed", "No exit speed keeps that chance", summary["generator"]["config_sha256"]):
        assert words in page
    assert "http" not in page.split("</style>")[1].split("Sources")[0].replace("http://www.w3.org", "")


def test_the_summary_tells_what_the_tables_hold(aimed_once: tuple[Path, int]) -> None:
    directory, _ = aimed_once
    tables = json.loads((directory / "summary.json").read_bytes())["tables"]
    for told in tables["aim-tables"]:
        table = read_json(directory / "tables" / f"{told['id']}.json", AimTable)
        assert (table.id, table.category.name) == (told["id"], told["category"])
        assert told["cells_without_speed"] == int(np.isnan(table.exit_speed_m_s).sum())
        assert table.interpolation_error_m_s == told["below_m_s"]
        cells = [cell for cell in tables["cells"] if cell["id"] == table.id]
        assert len(cells) == table.exit_speed_m_s.shape[0] * table.exit_speed_m_s.shape[1]
        if not table.is_measured:
            shape = table.exit_speed_m_s.shape
            shares = np.array([cell["overspeed"]["value"] for cell in cells]).reshape(shape)
            np.testing.assert_array_equal(shares, table.reported.p_overspeed)
            gaps = np.array([cell["gap_m"]["value"] for cell in cells]).reshape(shape)
            np.testing.assert_allclose(gaps, table.reported.mean_gap_m, rtol=1e-12)


def test_passes_and_seed_of_the_command_line_count(
    command: Command, aimed_once: tuple[Path, int], small: Path, tmp_path: Path
) -> None:
    before = json.loads((aimed_once[0] / "summary.json").read_bytes())
    ran = command("aim", small, "-o", tmp_path / "out", "--passes", 1000, "--seed", 7, "--json")
    assert ran.code == 0
    told = json.loads(ran.out)
    assert told == json.loads((tmp_path / "out" / "summary.json").read_bytes())
    assert [table["chosen_on_cuts"] for table in told["tables"]["aim-tables"]] == [1000] * 4
    assert told["config"]["numbers"]["simulation.seed"] == 7.0
    assert told["tables"]["cells"][0]["gap_m"] != before["tables"]["cells"][0]["gap_m"]
    assert ", about " not in ran.out
    assert "tables computed" in ran.err


def test_inspect_verify_and_export_take_what_aim_leaves(command: Command, aimed: Path, tmp_path: Path) -> None:
    ran = command("inspect", aimed)
    assert ran.code == 0
    assert "rnz-2m-park-L-measured" in ran.out
    assert command("verify", aimed).code == 0
    assert command("export", aimed, "--format", "c", "-o", tmp_path / "c").code == 0
    exported = files_in(tmp_path / "c")
    assert exported.pop("aim_configuration.toml") == (aimed / "configuration.toml").read_bytes()
    assert exported == files_in(aimed / "c")
    file = aimed / "tables" / "rnz-2m-park-L-category.csv"
    file.write_bytes(file.read_bytes().replace(b"1.3", b"1.4", 1))
    assert command("verify", aimed).code == 3


UNIFORM = """\
[track]
elements = [{ from_m = 0, to_m = 1200, grade_permille = 0.6 }]
bends = []
[weather]
head_wind_std_m_s = 0.0
[cuts]
mix = "still.toml"
categories = ["LS"]
cars = [1, 3]
[aim]
free_distances_m = [60.0, 180.0]
knowledge = ["category"]
exit_std_m_s = 0.0
[simulation]
passes = 20000
[output]
plots = false
report = false
"""


def test_the_speeds_are_those_of_the_closed_form_where_there_is_one(tmp_path: Path) -> None:
    """On an even grade, without wind and nearly without air, v² = v_c² + 2 g' (w0 − i) d: numpy alone, other draws."""
    text = "\n".join(MIXED.format(name) for name in ("gondola-4",))
    (tmp_path / "still.toml").write_text(HEAD + text, encoding="utf-8")
    (tmp_path / "aim.toml").write_text(UNIFORM, encoding="utf-8")
    assert main(["aim", str(tmp_path / "aim.toml"), "-o", str(tmp_path / "out")]) == 0
    table = read_json(tmp_path / "out" / "tables" / "rnz-2m-park-LS-category.json", AimTable)
    rng = np.random.default_rng(5)
    for cars in (1, 3):
        mass = rng.uniform(28.0, 44.0, (400_000, cars))
        shape, scale = (1.54 / 0.59) ** 2, 0.59**2 / 1.54
        basic = rng.gamma(shape, scale, mass.shape)
        total = mass.sum(axis=1)
        resistance, gravity = (mass * basic).sum(axis=1) / total, 9.81 / (1.0 + 0.42 * 4 * cars / total)
        for distance in (60.0, 180.0):
            energy = 1.39**2 + 2.0 * gravity * (resistance - 0.6) * distance * 1e-3
            critical = np.sort(np.sqrt(np.maximum(energy, 0.0)))
            # The quantile of 20 000 cuts lies between those of p ± 3.5 standard errors.
            spread = 3.5 * np.sqrt(0.1 * 0.9 / 20_000)
            low, high = np.quantile(critical, [0.1 - spread, 0.1 + spread])
            speed = aim_exit_speed(table, cars, distance, 0.0)
            assert speed is not None
            assert low - 0.004 <= speed <= high + 0.004  # rounded down to 0.001; the rest is the air that was left


HEAD = """\
title = "cars in still air"
following_share = { value = 0.25, range = [0, 1], source = "test", confidence = "H" }
underload_mean_t = { value = 4.0, range = [0, 9], source = "test", confidence = "H" }
"""
MIXED = """\
[cars.{0}]
share = {{ value = 1.0, range = [0, 1], source = "test", confidence = "H" }}
frontal_area_m2 = {{ value = 0.01, range = [0, 9], source = "test", confidence = "H" }}
drag_coefficient = {{ value = 0.01, range = [0, 9], source = "test", confidence = "H" }}
"""


STEEP = """\
[track]
elements = [{ from_m = 0, to_m = 340, grade_permille = 3 }, { from_m = 340, to_m = 900, grade_permille = 12 }]
bends = []
[cuts]
categories = ["T"]
cars = [1]
[aim]
free_distances_m = [200.0]
[simulation]
passes = 1000
[output]
plots = false
"""


def test_a_track_on_which_no_speed_is_safe_is_told_and_not_accepted(command: Command, tmp_path: Path) -> None:
    (tmp_path / "steep.toml").write_text(STEEP, encoding="utf-8")
    ran = command("aim", tmp_path / "steep.toml", "-o", tmp_path / "out")
    assert ran.code == 1
    assert "not accepted: no exit speed keeps the required probability anywhere" in ran.out
    table = read_json(tmp_path / "out" / "tables" / "rnz-2m-park-T-category.json", AimTable)
    assert np.isnan(table.exit_speed_m_s).all()
    assert aim_exit_speed(table, 1, 200.0, 0.0) is None
    assert "Not accepted" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")


def test_a_book_of_another_position_is_refused(command: Command, tuned: Path, tmp_path: Path) -> None:
    (tmp_path / "aim.toml").write_text(
        f'[position]\nname = "knp-5-bunch"\n[aim]\ntables = "{tuned / "book.h5"}"\n', encoding="utf-8"
    )
    ran = command("aim", tmp_path / "aim.toml", "-o", tmp_path / "out")
    assert ran.code == 2
    assert "is for the position rnz-2m-park, but position.name is knp-5-bunch" in ran.sentence


PARK = """\
[position]
name = "rnz-2m-park"
[entry]
low_m_s = 3.0
high_m_s = 4.8
[targets]
exit_speeds_m_s = [1.2, 2.0, 3.0]
[grid]
path_step_m = 1.0
speed_step_m_s = 0.04
friction_scenarios = 3
resistance_scenarios = 1
[fit]
degree = 2
[validation]
passes = 1000
[output]
plots = false
report = false
[[cut]]
car = "gondola-4"
mass_t = 24
"""
BY_TABLES = """\
[cuts]
categories = ["L"]
cars = [1]
[aim]
free_distances_m = [100.0]
tables = "park/book.h5"
tables_config = "park.toml"
[simulation]
passes = 2000
[output]
plots = false
report = false
"""


def test_a_position_that_runs_its_own_tables(command: Command, tmp_path: Path) -> None:
    (tmp_path / "park.toml").write_text(PARK, encoding="utf-8")
    command("tune", tmp_path / "park.toml", "-o", tmp_path / "park")
    config = tmp_path / "aim.toml"
    config.write_text(BY_TABLES, encoding="utf-8")
    assert command("aim", config, "-o", tmp_path / "out").code == 0
    summary = json.loads((tmp_path / "out" / "summary.json").read_bytes())
    assert summary["config"]["tables_sha256"] == hashlib.sha256((tmp_path / "park/book.h5").read_bytes()).hexdigest()
    assert "aim.exit_std_m_s" not in summary["config"]["numbers"]
    found = summary["tables"]["cells"][0]
    assert found["overspeed"]["low95"] <= 0.11
    assert 5.0 < found["gap_m"]["value"] < 20.0  # 11.7 m with a normal error of 0.1 m/s
    config.write_text(BY_TABLES.replace("cars = [1]", "cars = [1, 2]"), encoding="utf-8")
    ran = command("aim", config, "-o", tmp_path / "no")
    assert ran.code == 2
    assert "which does not fit: tables: none for 2 cars of category Л" in ran.sentence
    assert not (tmp_path / "no").exists()
