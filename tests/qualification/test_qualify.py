"""The command judges by what failed and tells what it could not check; a package with another file is told."""

from __future__ import annotations

import base64
import hashlib
import json
import subprocess
from collections.abc import Callable
from dataclasses import replace
from importlib.metadata import Distribution, PathDistribution
from pathlib import Path

import pytest

from synth.cli import main
from synth.cli.qualification import installed, qualified
from synth.cli.qualification.check import Check, Outcome, checked, not_checked
from synth.cli.qualification.qualified import Qualified
from synth.frame.version import Defect

PASSED = checked("bytes", "by hash", "equal", "equal", holds=True)
LEFT = not_checked("compiler", "self-test", "not on PATH: cc", "sound", "put a compiler on PATH")
FAILED = checked("claim", "by simulation", "0.3 m/s", "at most 0.1 m/s", holds=False)


@pytest.mark.parametrize(
    ("checks", "code", "sentence"),
    [
        ((PASSED, PASSED), 0, "2 checks passed, none failed"),
        ((PASSED, LEFT), 0, "1 check passed, none failed; 1 check could not be made"),
        ((PASSED, LEFT, FAILED), 1, "claim: 0.3 m/s; asked: at most 0.1 m/s"),
    ],
)
def test_the_exit_code_is_that_of_what_was_checked(
    checks: tuple[Check, ...], code: int, sentence: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def made(done: Callable[[str], None]) -> Qualified:
        return Qualified(checks, (), {"measured/a.json": b"{}"})

    monkeypatch.setattr(qualified, "qualified", made)
    assert main(["qualify", "-o", str(tmp_path / "out"), "-q"]) == code
    summary = json.loads((tmp_path / "out" / "summary.json").read_bytes())
    assert [limit["sentence"] for limit in summary["limits"]] == [sentence]
    assert [row["outcome"] for row in summary["tables"]["checks"]] == [check.outcome.value for check in checks]
    page = (tmp_path / "out" / "report.html").read_text()
    assert (LEFT.remedy in page) == (LEFT in checks)
    assert (tmp_path / "out" / "measured" / "a.json").read_bytes() == b"{}"


FILES = {"synth/a.py": b"a = 1\n", "synth/b.toml": b"b = 2\n"}


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Distribution:
    """A program that pip has installed."""
    metadata = tmp_path / "retarder_synth-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: retarder-synth\nVersion: 1.0\n")
    lines = []
    for name, content in FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(content)
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")
        lines.append(f"{name},sha256={digest},{len(content)}")
    (metadata / "RECORD").write_text("\n".join([*lines, "retarder_synth-1.0.dist-info/RECORD,,", ""]))
    found = PathDistribution(metadata)
    monkeypatch.setattr(installed, "distribution", lambda name: found)
    return found


def test_a_sound_installation_passes(package: Distribution) -> None:
    check = installed.program_check()
    assert (check.outcome, check.found) == (Outcome.PASSED, "retarder-synth 1.0, 2 files; none differs")
    assert installed.own_content().sha256 == installed.installed(package).sha256


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda folder: (folder / "synth/a.py").write_bytes(b"a = 2\n"), "1 differ: synth/a.py"),
        (lambda folder: (folder / "synth/b.toml").unlink(), "1 differ: synth/b.toml"),
        (lambda folder: (folder / "synth/c.py").write_bytes(b""), "1 differ: c.py was added"),
    ],
)
def test_a_changed_file_is_told(package: Distribution, tmp_path: Path, change: object, told: str) -> None:
    before = installed.own_content().sha256
    assert callable(change)
    change(tmp_path)
    check = installed.program_check()
    assert (check.outcome, check.found.partition("; ")[2]) == (Outcome.FAILED, told)
    assert installed.own_content().sha256 != before


def test_only_an_unsafe_defect_of_this_version_fails(package: Distribution) -> None:
    safe = Defect("D-1", "0.9", "1.1", ("lines",), ("made",), False, "it is slow", "none", "look", "wait")
    assert installed.defect_check(()).found == "version 1.0: none"
    assert installed.defect_check((safe,)).outcome is Outcome.PASSED
    assert installed.defect_check((safe,)).found == "version 1.0: D-1: it is slow"
    assert installed.defect_check((replace(safe, unsafe=True),)).outcome is Outcome.FAILED
    assert installed.defect_check((replace(safe, unsafe=True, fixed="1.0"),)).outcome is Outcome.PASSED


def git(folder: Path, *words: str) -> None:
    name = ("-c", "user.name=a", "-c", "user.email=a@b.c")
    subprocess.run(["git", "-C", folder, *name, *words], check=True, capture_output=True)


def test_a_checkout_is_that_of_a_commit_or_is_not_checked(tmp_path: Path) -> None:
    assert installed.checkout_check(tmp_path).outcome is Outcome.NOT_CHECKED
    (tmp_path / "synth").mkdir()
    (tmp_path / "synth/a.py").write_text("a = 1\n")
    git(tmp_path, "init")
    git(tmp_path, "add", ".")
    git(tmp_path, "commit", "-m", "first")
    assert installed.checkout_check(tmp_path).outcome is Outcome.PASSED
    (tmp_path / "synth/b.py").write_text("b = 1\n")
    check = installed.checkout_check(tmp_path)
    assert check.outcome is Outcome.NOT_CHECKED
    assert "with changes: 1 differ: synth/b.py" in check.found


def test_every_library_that_is_needed_is_read() -> None:
    found = installed.libraries()
    assert {"numba", "numpy", "scipy", "control"} <= {each.name for each in found}
    assert all(each.files > 0 for each in found)
