"""A sweep and a tune never mix their results in one directory."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.sweep.conftest import PLANT, SWEEP, Ran, contents

TUNE = (
    PLANT
    + """\
[targets]
exit_speeds_m_s = [1.5]
[validation]
passes = 1000
[output]
plots = false
[[cut]]
car = "gondola-4"
mass_t = 22
"""
)
CONDITIONS = PLANT + SWEEP + '[[sweep.condition]]\nname = "dry"\n[[sweep.condition]]\nname = "wet"\n'


@pytest.fixture
def tune_config(tmp_path: Path) -> Path:
    path = tmp_path / "tune.toml"
    path.write_text(TUNE, encoding="utf-8")
    return path


@pytest.fixture
def conditions(tmp_path: Path) -> Path:
    path = tmp_path / "conditions.toml"
    path.write_text(CONDITIONS, encoding="utf-8")
    return path


def test_no_tune_into_a_sweep(command: Callable[..., Ran], serial: Path, tune_config: Path, tmp_path: Path) -> None:
    out = Path(shutil.copytree(serial, tmp_path / "out"))
    before = contents(out)
    code, told, said = command("tune", tune_config, "-o", out)
    assert (code, told) == (2, "")
    assert f"{out}: it holds the results of 'sweep run'; give another directory by -o" in said
    assert contents(out) == before


def test_no_tune_into_a_condition_of_a_sweep(
    command: Callable[..., Ran], serial: Path, tune_config: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = Path(shutil.copytree(serial, tmp_path / "out"))
    (out / "dry").mkdir()
    shutil.copy(out / "config.toml", out / "dry")
    for path in (out / "dry", Path("."), out / "dry" / ".." / "dry"):
        monkeypatch.chdir(out / "dry")
        code, _, said = command("tune", tune_config, "-o", path)
        assert code == 2
        assert "it holds config.toml, which 'tune' did not write" in said
    assert [path.name for path in (out / "dry").iterdir()] == ["config.toml"]


@pytest.mark.parametrize("name", ["book.h5", "summary.json", "report.html", "c/retarder_table.c"])
def test_no_sweep_into_a_tune(
    command: Callable[..., Ran], config: Path, conditions: Path, tmp_path: Path, name: str
) -> None:
    for file, folder in ((config, tmp_path / "out"), (conditions, tmp_path / "outer" / "wet")):
        (folder / name).parent.mkdir(parents=True)
        (folder / name).write_bytes(b"of a tune")
        code, _, said = command("sweep", "run", file, "-o", tmp_path / folder.relative_to(tmp_path).parts[0])
        assert code == 2
        assert f"{name}, which 'sweep run' did not write; give a new or an empty directory by -o" in said
        assert contents(folder) == {name: b"of a tune"}


def test_a_tune_below_a_sweep_is_no_condition_of_it(
    command: Callable[..., Ran], serial: Path, tune_config: Path, tmp_path: Path
) -> None:
    out = Path(shutil.copytree(serial, tmp_path / "out"))
    assert command("tune", tune_config, "-o", out / "tune")[0] in (0, 1)
    assert (out / "tune" / "summary.json").exists()
