"""`retarder-synth loop`: pictures and figures of exported tables as control loops, and what it refuses."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.system.conftest import Command

pytest.importorskip("control")

TABLE = "gondola-4-22t-to-1.5-m-s"


def test_a_directory_gives_pictures_figures_and_a_table(
    command: Command, tuned: Path, two_classes: Path, tmp_path: Path
) -> None:
    out = tmp_path / "loops"
    ran = command("loop", tuned, "-o", out, "--config", two_classes)
    assert ran.code == 0
    document = json.loads((out / "loops.json").read_bytes())
    assert [each["id"] for each in document["loops"]] == [TABLE, "gondola-4-30t-to-1.5-m-s"]
    names = {path.name for path in out.iterdir()} - {"loops.json"}
    assert {str(out / name) for name in names} == set(document["files"])
    assert {f"{TABLE}-response.png", f"{TABLE}-portrait.svg"} <= names
    assert all((out / name).read_bytes()[:4] == b"\x89PNG" for name in names if name.endswith(".png"))
    for each in document["loops"]:
        assert each["difference"]["agrees"] is True
        assert abs(each["difference"]["largest_m_s"]) <= each["difference"]["tolerance_m_s"]
        assert f"{each['python_control']['exit_speed_m_s']:.4f}" in ran.out
        cycles = sum(name.startswith(f"{each['id']}-cycle") for name in names)
        assert cycles == 2 * len(each["limit_cycles"])  # PNG and SVG
    assert "Python-control and the simulator agree where" in ran.out


def test_json_is_the_file_and_the_same_table_gives_the_same_bytes(
    command: Command, tuned: Path, two_classes: Path, tmp_path: Path
) -> None:
    table = tuned / "tables" / f"{TABLE}.json"
    first = command("loop", table, "-o", tmp_path / "one", "--config", two_classes, "--json")
    assert first.code == 0
    assert json.loads(first.out) == json.loads((tmp_path / "one" / "loops.json").read_bytes())
    assert command("loop", table, "-o", tmp_path / "two", "--config", two_classes).code == 0
    for path in (tmp_path / "one").iterdir():
        if path.name != "loops.json":  # it names the files, which lie elsewhere
            assert path.read_bytes() == (tmp_path / "two" / path.name).read_bytes()


def test_responses_that_do_not_agree_give_1(
    command: Command, tuned: Path, two_classes: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("synth.book.control_loop.TOLERANCE_M_S", 1e-9)
    ran = command("loop", tuned / "tables" / f"{TABLE}.json", "-o", tmp_path / "out", "--config", two_classes)
    assert ran.code == 1
    assert "DO NOT agree" in ran.err


def test_bad_input_is_one_sentence(command: Command, tuned: Path, tmp_path: Path) -> None:
    table = tuned / "tables" / f"{TABLE}.json"
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
