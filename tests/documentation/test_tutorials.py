"""Every tutorial runs as it stands: its files are written, its commands typed, and what it shows is what they print."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [page for page in sorted((ROOT / "docs" / "tutorials").glob("*.md")) if page.stem != "index"]

BLOCK = re.compile(r"^```(sh|text|toml|python)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
NAME = re.compile(r"# (\S+\.toml)\n")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_tutorial_runs_as_it_stands(page: Path, tmp_path: Path) -> None:
    """A file is named in its first line; a text after commands shows lines that they print, in their order."""
    printed, shown = "", 0
    for kind, text in BLOCK.findall(page.read_text(encoding="utf-8")):
        match kind:
            case "toml":
                named = NAME.match(text)
                assert named is not None, f"{page.name}: a file without a name: {text}"
                (tmp_path / named[1]).write_text(text, encoding="utf-8")
            case "sh":
                printed = typed(text, tmp_path)
            case "python":
                printed = run([sys.executable, "-c", text], tmp_path)
            case _:
                require_shown(text, printed)
                shown += 1
    assert shown > 0


def typed(commands: str, folder: Path) -> str:
    """What these commands print, in a terminal of 100 columns."""
    return run(["bash", "-euo", "pipefail", "-c", commands], folder)


def run(command: list[str], folder: Path) -> str:
    """What a process prints; it must end well."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        command, cwd=folder, env={**os.environ, "PATH": path, "COLUMNS": "100"}, text=True, check=False,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout
    return done.stdout


def require_shown(text: str, printed: str) -> None:
    """The words of `text` stand in what was printed, in their order, whatever digits stand there."""
    at = 0
    for line in sentences(text):
        found = masked(printed).find(line, at)
        assert found >= 0, f"{line!r} is not in what was printed:\n{printed}"
        at = found + len(line)


def sentences(text: str) -> list[str]:
    """The lines of a text; one that begins in small letters goes on with the line before."""
    joined = re.sub(r"\n(?=m/s\))", " ", text.strip())
    return [masked(line).strip() for line in joined.splitlines()]


def masked(text: str) -> str:
    """A text with every number as #, and one space between words."""
    return re.sub(r"-?\d+(\.\d+)?", "#", re.sub(r"\s+", " ", text))
