"""Every tutorial runs as it stands: its files are written, its commands typed, and what it shows is what they print."""

from __future__ import annotations

import re
import shlex
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from synth.cli import main

ROOT = Path(__file__).parents[2]
PAGES = [page for page in sorted((ROOT / "docs" / "tutorials").glob("*.md")) if page.stem != "index"]

BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
NAME = re.compile(r"# (\S+\.toml)\n")
PROGRAM = re.compile(r"^(retarder-synth .*)\n|((?:(?!retarder-synth ).*\n)+)", re.MULTILINE)
"""A command of the program, or lines of something else."""


@pytest.fixture
def reader(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Callable[[str], str]:
    """Types commands in a folder of his own, in a terminal of 100 columns, and tells what they print."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "100")

    def typed(commands: str) -> str:
        capfd.readouterr()
        for program, others in PROGRAM.findall(commands):
            if program:
                give(program)
            else:
                subprocess.run(["bash", "-euo", "pipefail", "-c", others], check=True)
        return "".join(capfd.readouterr())

    return typed


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_tutorial_runs_as_it_stands(page: Path, reader: Callable[[str], str]) -> None:
    """A file is named in its first line; a text after commands shows lines that they print, in their order."""
    printed, shown = "", 0
    for kind, text in BLOCK.findall(page.read_text(encoding="utf-8")):
        match kind:
            case "toml":
                named = NAME.match(text)
                assert named is not None, f"{page.name}: a file without a name: {text}"
                Path(named[1]).write_text(text, encoding="utf-8")
            case "sh":
                printed = reader(text)
            case "text":
                require_shown(text, printed)
                shown += 1
            case _:
                pytest.fail(f"{page.name}: no reader types {kind}")
    assert shown > 0


def give(line: str) -> None:
    """Give a command of the program in this process; it must end well, or may miss a limit before `|| true`."""
    command = line.removesuffix(" || true")
    assert not re.search(r"[|&;<>$`*?]", command), f"a shell is needed for {line!r}"
    code = main(shlex.split(command)[1:])
    assert code == 0 or (code == 1 and command != line), (line, code)


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
