"""The installed program as its user runs it: a process of its own, in a folder, with what it is told and printed."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

ENTRY: Final = (sys.executable, "-P", "-c", "from synth.cli import script; script()")
"""What the installed command `retarder-synth` calls."""

EPOCH: Final = "1700000000"
"""The creation date of all files that are made, in seconds since 1970, so that equal tables are equal files."""

LONGEST_S: Final = 3600.0
"""Of a run of the program itself; the kernels may have to be compiled."""

BUILD_S: Final = 300.0
"""Of all others, as a compiler: one that waits for something would wait for ever."""


@dataclass(frozen=True)
class Ran:
    """A finished process: its exit code, what it printed, and its complaints."""

    code: int
    out: str
    err: str

    @property
    def document(self) -> Any:
        """What it printed, as JSON; None where that is none."""
        try:
            return json.loads(self.out)
        except ValueError:
            return None

    @property
    def sentence(self) -> str:
        """Exit code and last complaint."""
        lines = self.err.strip().splitlines()
        return f"exit code {self.code}{f': {lines[-1]}' if lines else ''}"


def process(
    words: list[str], folder: Path, surroundings: Mapping[str, str] | None = None, longest_s: float = BUILD_S
) -> Ran:
    """Run `words` in `folder`; what does not start, or has not ended after `longest_s`, has the exit code -1."""
    environment = {**os.environ, **(surroundings or {})}
    try:
        ran = subprocess.run(
            words, cwd=folder, env=environment, capture_output=True, text=True, errors="replace",
            stdin=subprocess.DEVNULL, timeout=longest_s, check=False,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return Ran(-1, "", f"{words[0]} has not ended after {longest_s:g} s")
    except OSError as fault:
        return Ran(-1, "", str(fault))
    return Ran(ran.returncode, ran.stdout, ran.stderr)


def program(line: str, folder: Path, surroundings: Mapping[str, str] | None = None) -> Ran:
    """Run `retarder-synth` with the words of `line` in `folder`."""
    return process([*ENTRY, *line.split()], folder, {"SOURCE_DATE_EPOCH": EPOCH, **(surroundings or {})}, LONGEST_S)
