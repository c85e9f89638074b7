"""What makes a checkout no release is told: uncommitted files, two versions, a lock that does not fit, other bytes."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from scripts.release.bare import pythons
from scripts.release.built import require_equal
from scripts.release.step import ReleaseFault, Step
from scripts.release.tree import clean, lock_fits, one_version, project

ROOT = Path(__file__).parents[2]


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """The files that are looked at, with a changelog of this version."""
    for name in ("pyproject.toml", "requirements.lock", "CITATION.cff"):
        shutil.copy(ROOT / name, tmp_path)
    (tmp_path / "CHANGELOG.md").write_text(f"# Changelog\n\n## [{project(ROOT)['version']}] - 2026-12-01\n")
    return tmp_path


def change(file: Path, old: str, new: str) -> None:
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new), encoding="utf-8")


def test_a_sound_checkout_is_one(checkout: Path) -> None:
    assert one_version(checkout) == f"version {project(ROOT)['version']}"
    assert "every requirement has an allowed version" in lock_fits(checkout)


@pytest.mark.parametrize("name", ["CHANGELOG.md", "CITATION.cff"])
def test_another_version_is_told(checkout: Path, name: str) -> None:
    change(checkout / name, project(ROOT)["version"], "0.0.9")
    with pytest.raises(ReleaseFault, match=rf"but {name} tells 0\.0\.9"):
        one_version(checkout)


@pytest.mark.parametrize(("old", "new"), [("simpy==", "other=="), ("simpy==4", "simpy==3")])
def test_a_lock_that_does_not_fit_is_told(checkout: Path, old: str, new: str) -> None:
    change(checkout / "requirements.lock", old, new)
    with pytest.raises(ReleaseFault, match=r"nothing that fits simpy>=4\.1"):
        lock_fits(checkout)


def test_an_uncommitted_file_is_told(checkout: Path) -> None:
    subprocess.run(["git", "init"], cwd=checkout, check=True, capture_output=True)
    with pytest.raises(ReleaseFault, match="4 files are not committed"):
        clean(checkout)


def test_other_bytes_are_told(checkout: Path) -> None:
    require_equal(checkout / "CITATION.cff", ROOT / "CITATION.cff")
    with pytest.raises(ReleaseFault, match="differ"):
        require_equal(checkout / "CITATION.cff", checkout / "CHANGELOG.md")


def test_interpreters_that_do_not_start_are_told_apart() -> None:
    assert pythons([sys.executable, "python9.9"]) == ([sys.executable], ["python9.9"])


def test_a_fault_is_printed_and_counts(capsys: pytest.CaptureFixture[str]) -> None:
    def fault() -> str:
        raise ReleaseFault("no")

    assert not Step("lock", fault).told()
    assert Step("tree", lambda: "clean").told()
    assert [line.split()[:2] for line in capsys.readouterr().out.splitlines()] == [["lock", "FAILED"], ["tree", "ok"]]
