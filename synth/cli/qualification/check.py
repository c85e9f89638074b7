"""One check of a qualification (what was looked at, how, what was found, what it comes to), and the installed
program as its user runs it: a process of its own, in a folder, with what it is told and printed.
"""

from __future__ import annotations

import atexit
import json
import os
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any, Final

from synth.frame.terminal.telling import printable
from tuning_tables.errors import excerpt

LONGEST: Final = 1000
"""Characters of what was found: compilers may say anything."""


class Outcome(Enum):
    """What a check comes to."""

    PASSED = "passed"
    FAILED = "failed"
    NOT_CHECKED = "not checked"


@dataclass(frozen=True)
class Check:
    """A row of the page, in words: `what` was checked, `how`, what was `found`, and the `limit` that it is held to.

    Of what could not be checked `found` is the reason, and `remedy` what would make the check possible; "" if nothing.
    """

    what: str
    how: str
    found: str
    limit: str
    outcome: Outcome
    remedy: str = ""


def checked(what: str, how: str, found: str, limit: str, holds: bool) -> Check:
    """A check that was made."""
    told = excerpt(printable(found), LONGEST)
    return Check(what, how, told, limit, Outcome.PASSED if holds else Outcome.FAILED)


def not_checked(what: str, how: str, reason: str, limit: str, remedy: str = "") -> Check:
    """A check that could not be made, with the reason."""
    return Check(what, how, reason, limit, Outcome.NOT_CHECKED, remedy)


WATCH: Final = (
    "import os, threading; threading.Thread(target=lambda: os.read(0, 1) or os._exit(1), daemon=True).start()"
)
"""Ends a process once the other end of its standard input is closed: where its parent was killed, too."""

ENTRY: Final = (sys.executable, "-P", "-c", f"{WATCH}; from synth.cli import script; script()")
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
    words: list[str],
    folder: Path,
    surroundings: Mapping[str, str] | None = None,
    longest_s: float = BUILD_S,
    given: int = subprocess.DEVNULL,
) -> Ran:
    """Run `words` in `folder` with the standard input `given`.

    What does not start, or has not ended after `longest_s`, has the exit code -1.
    """
    environment = {**os.environ, **(surroundings or {})}
    try:
        child = subprocess.Popen(
            words, cwd=folder, env=environment, text=True, errors="replace",
            stdin=given, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        )  # fmt: skip
    except OSError as fault:
        return Ran(-1, "", str(fault))
    atexit.register(child.kill)  # where this process is asked to end, nobody waits for the other one
    with child:
        try:
            out, err = child.communicate(timeout=longest_s)
        except subprocess.TimeoutExpired:
            child.kill()
            return Ran(-1, "", f"{words[0]} has not ended after {longest_s:g} s")
        finally:
            atexit.unregister(child.kill)
    return Ran(child.returncode, out, err)


def program(line: str, folder: Path, surroundings: Mapping[str, str] | None = None) -> Ran:
    """Run `retarder-synth` with the words of `line` in `folder`; it ends with this process, however that ends."""
    environment = {"SOURCE_DATE_EPOCH": EPOCH, **(surroundings or {})}
    watched, held = os.pipe()
    try:
        return process([*ENTRY, *line.split()], folder, environment, LONGEST_S, watched)
    finally:
        os.close(watched)
        os.close(held)
