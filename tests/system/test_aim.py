"""`aim` from the command line to its last file: what it leaves and tells."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from synth.cli import main
from tests.frame.results import results_in
from tests.system.conftest import EPOCH, Command
from tuning_tables.aim.aim_table import AimTable
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


@pytest.mark.long
@pytest.mark.parametrize("threads", [1, 2])
def test_no_table_depends_on_the_number_of_threads(
    aimed_once: tuple[Path, int], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, threads: int
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", EPOCH)
    config = tmp_path / "aim.toml"
    config.write_text(f"{SMALL}threads = {threads}\n", encoding="utf-8")
    assert main(["aim", str(config), "-o", str(tmp_path / "out")]) == 0
    first, again = files_in(aimed_once[0]), files_in(tmp_path / "out")
    of_threads = {"configuration.toml", "report.html", "summary.json"}  # these tell the configuration
    assert {name for name in first if first[name] != again[name]} <= of_threads


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
