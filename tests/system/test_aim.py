"""`aim` from the command line to its last file: what it leaves, repeats and refuses, and what a kill leaves."""

from __future__ import annotations

import hashlib
import json
import os
import random
import re
import shutil
import subprocess
import sys
import time
import tomllib
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from synth.cli import main
from synth.frame.own_files import MARKER
from synth.frame.results_directory import CONFIGURATION, LEFTOVER
from tests.frame.results import results_in
from tests.printed_page import Page, page_about, require_column, table_of
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
AIM = [sys.executable, "-c", "import sys; from synth.cli import main; raise SystemExit(main(sys.argv[1:]))", "aim"]


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


def check(out: Path) -> None:
    """Every file is whole, and a summary describes exactly the files that are there."""
    for path in out.rglob("*"):
        if path.is_file() and path.name != MARKER and not LEFTOVER.fullmatch(path.name):
            check_file(path)
    if (out / "summary.json").exists():
        for name, digest in json.loads((out / "summary.json").read_bytes())["files"].items():
            assert hashlib.sha256((out / name).read_bytes()).hexdigest() == digest, name


def check_file(path: Path) -> None:
    content = path.read_bytes()
    match path.parent.name, path.suffix:
        case "tables", ".json":
            read_json(path, AimTable)
        case (("tables" | "c" | "sheets"), ".csv"):
            assert content.endswith(b"\r\n")
        case "c", ".c" | ".h":
            assert content.startswith(b"/* ")
            assert content.endswith((b"\n}\n", b"#endif\n"))
        case "st", ".st":
            assert content.startswith(b"(*")
            assert content.endswith(b"END_FUNCTION_BLOCK\n")
        case "plots", ".svg":
            ElementTree.fromstring(content)
        case _, ".html":
            assert content.endswith(b"</html>\n")
        case _, ".toml":
            assert content
            tomllib.loads(content.decode("utf-8"))
        case _:
            assert path.name == "summary.json"
            json.loads(content)


def test_aim_leaves_tables_code_pictures_report_and_a_summary_of_them(aimed_once: tuple[Path, int]) -> None:
    directory, code = aimed_once
    assert code == 0
    check(directory)
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


def in_short(gap: dict[str, float]) -> str:
    """A mean gap as a terminal tells it: a bound where none was met, brackets where a half would print as 0."""
    value, low, high = (gap[key] for key in ("value", "low95", "high95"))
    if value == low == 0.0 < high:
        return f"below {high:.2f}"
    half = f"{max(value - low, high - value):.2f}"
    return f"{value:.2f} [{low:.2f}, {high:.2f}]" if half == "0.00" else f"{value:.2f} ±{half}"


def test_it_prints_the_figures_of_its_summary(aimed_once: tuple[Path, int], pages: list[Page]) -> None:
    directory, _ = aimed_once
    rows = json.loads((directory / "summary.json").read_bytes())["tables"]["gaps"]
    told = table_of(page_about(pages, directory))
    require_column(told, "cuts", [row["cuts"] for row in rows])
    require_column(told, "cars", [str(row["cars"]) for row in rows])
    distances = [heading for heading in told[0] if heading.startswith("gap at ")]
    assert len(distances) > 1
    for heading in distances:
        gaps = [row[f"at_{heading.split()[2]}_m"] for row in rows]
        require_column(told, heading, [in_short(gap) for gap in gaps])
    for row, printed in zip(rows, told, strict=True):
        numbers = [float(word) for word in re.findall(r"[\d.]+", printed["worst cell, over-speed"])]
        value, low, high = (100.0 * row["worst"][key] for key in ("value", "low95", "high95"))
        assert numbers == pytest.approx([value, max(value - low, high - value)] if value else [high], rel=0.05)


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


def without_configuration(files: dict[str, bytes]) -> dict[str, bytes]:
    """The files but the configuration, which tells the threads; without its hash, and that of the page."""
    found = {name: content for name, content in files.items() if name != CONFIGURATION}
    for name in (CONFIGURATION, "report.html"):
        sha256 = hashlib.sha256(files[name]).hexdigest().encode("ascii")
        found = {each: content.replace(sha256, b"") for each, content in found.items()}
    return found


@pytest.mark.long
def test_the_same_bytes_twice_and_for_any_number_of_threads(
    aimed_once: tuple[Path, int], small: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", EPOCH)
    first = files_in(aimed_once[0])
    for threads in (1, 2, 4):
        config = tmp_path / f"{threads}.toml"
        config.write_text(SMALL + f"threads = {threads}\n", encoding="utf-8")
        out = tmp_path / f"out-{threads}"
        assert main(["aim", str(config), "-o", str(out)]) == 0
        assert without_configuration(files_in(out)) == without_configuration(first), threads
    assert main(["aim", str(small), "-o", str(tmp_path / "out-1")]) == 0  # over an earlier one
    assert files_in(tmp_path / "out-1") == first


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


def test_stale_files_go_and_those_of_others_stay(command: Command, aimed: Path, tmp_path: Path) -> None:
    notes = aimed / "tables" / "notes.json"
    notes.write_text("{}", encoding="utf-8")
    (aimed / "plots" / "mine.png").write_bytes(b"x")
    config = tmp_path / "one.toml"
    config.write_text(
        SMALL.replace('["L", "T"]', '["L"]').replace("2000", "1000") + "[output]\nplots = false\n", "utf-8"
    )
    assert command("aim", config, "-o", aimed).code == 0
    names = set(files_in(aimed))
    assert {"tables/notes.json", "plots/mine.png"} <= names
    assert not any("-T-" in name or name.startswith("plots/aim") for name in names)
    check_summary = json.loads((aimed / "summary.json").read_bytes())
    assert names - {"summary.json", "tables/notes.json", "plots/mine.png"} == set(check_summary["files"])


def test_directories_of_tune_and_aim_are_kept_apart(
    command: Command, aimed: Path, tuned: Path, small: Path, one_class: Path
) -> None:
    ran = command("aim", small, "-o", tuned)
    assert (ran.code, "holds the results of 'tune'" in ran.sentence) == (2, True)
    ran = command("tune", one_class, "-o", aimed)
    assert (ran.code, "holds the results of 'aim'" in ran.sentence) == (2, True)


@pytest.mark.requirement("CMD-06")
@pytest.mark.long
def test_killed_aims_leave_nothing_half_done(aimed: Path, small: Path, tmp_path: Path) -> None:
    config = tmp_path / "one.toml"
    config.write_text(SMALL.replace('["L", "T"]', '["L"]'), encoding="utf-8")
    rng = random.Random(20261122)
    for words, longest in (("", 3.0), ("tables computed", 0.6), ("tables computed", 2.0), ("pictures drawn", 0.1)):
        aim = subprocess.Popen(
            [*AIM, str(config), "-o", str(aimed)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
        )
        assert aim.stderr is not None
        for line in aim.stderr if words else ():
            if words in line:
                break
        time.sleep(rng.uniform(0.0, longest))
        aim.kill()
        aim.communicate()
        check(aimed)
    assert main(["aim", str(config), "-o", str(aimed)]) == 0
    check(aimed)
    files = set(files_in(aimed))
    assert files - {"summary.json"} == set(json.loads((aimed / "summary.json").read_bytes())["files"])


@pytest.mark.long
def test_the_default_needs_no_file(tmp_path: Path) -> None:
    """Only the fewest passes: what it computes is the default otherwise."""
    ran = subprocess.run(
        [*AIM, "-o", str(tmp_path / "out"), "--passes", "1000"],
        capture_output=True, text=True, check=False, env={**os.environ, "SOURCE_DATE_EPOCH": EPOCH},
    )  # fmt: skip
    assert ran.returncode == 0, ran.stderr
    summary = json.loads((tmp_path / "out" / "summary.json").read_bytes())
    assert len(summary["tables"]["aim-tables"]) == 10
    first = summary["tables"]["aim-tables"][0]["id"]
    cars = {cell["cars"] for cell in summary["tables"]["cells"] if cell["id"] == first}
    assert cars == {1, 2, 3, 5, 8, 15}
    assert "accepted: " in ran.stdout
