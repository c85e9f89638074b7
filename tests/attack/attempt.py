"""One attempt: a changed file is put before the reader that the commands use, and what comes of it is judged."""

from __future__ import annotations

import contextlib
import io
import random
import re
import time
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Final

from synth.cli import told
from synth.frame.terminal.telling import MACHINE_FAULT, OK, UNFORESEEN
from tests.attack.mutants import Change, changed_text

LONGEST: Final = 700
"""Letters of one sentence."""

NEVER: Final = r"(?!)"
"""A pattern that nothing matches."""


class Reading(StrEnum):
    """What may be read from a changed file, if it is not refused."""

    ANY = "anything"
    SAME = "the original"
    OTHER = "not the original"
    NONE = "nothing"


class Outcome(StrEnum):
    """What came of an attempt; only the first two are sound."""

    REFUSED = "refused"
    ACCEPTED = "accepted"
    TRACEBACK = "traceback"
    HANG = "hang"
    MEMORY = "memory"
    CRASH = "crash"
    MISREAD = "misread"
    WRONG_CODE = "wrong code"
    WRONG_FILE = "wrong file"
    NO_LINE = "no line"
    WARNING = "warning"


@dataclass(frozen=True)
class Changed:
    """A changed file, what was changed, and what may be read from it."""

    content: bytes
    how: str
    allowed: Reading


@dataclass(frozen=True)
class Kind:
    """A kind of input: `files` in a folder, of which `attacked` is changed; `read` takes the folder and tells what was
    read. `change`: what is done to it at random. `code`: with which it is refused. `elsewhere`: pattern of sentences
    that need not name the attacked file. `first`: changed files that are tried before random ones.
    """

    name: str
    files: Mapping[str, bytes]
    attacked: str
    read: Callable[[Path], str]
    change: Change = changed_text
    code: int = 2
    allowed: Reading = Reading.ANY
    elsewhere: str = NEVER
    first: tuple[Changed, ...] = ()

    def changed(self, seed: int, number: int) -> Changed:
        """The changed file with that number: always the same."""
        if number < len(self.first):
            return self.first[number]
        dice = random.Random(f"{self.name} {seed} {number}")
        return Changed(self.change(self.files[self.attacked], dice), "random", self.allowed)

    def put_into(self, folder: Path, attacked: bytes | None = None) -> None:
        """Write the files, the attacked one with this content if it is given."""
        for name, content in self.files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_bytes(attacked if attacked is not None and name == self.attacked else content)


@dataclass(frozen=True)
class Attempt:
    """What came of attempt `number`, and what shows it."""

    number: int
    outcome: Outcome
    detail: str
    seconds: float


def attempted(kind: Kind, number: int, changed: Changed, folder: Path, original: str) -> Attempt:
    """Read the changed file in `folder`, where the others are; `original`: what the unchanged one reads as."""
    (folder / kind.attacked).write_bytes(changed.content)
    read: list[str] = []

    def call() -> int:
        read.append(kind.read(folder))
        return OK

    started, out, err = time.monotonic(), io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        code = told(call)
    seconds = time.monotonic() - started
    said = [line.removeprefix("retarder-synth: ") for line in err.getvalue().split("\n")[:-1]]
    outcome, detail = judged(kind, code, said, folder)
    if seen:
        outcome, detail = Outcome.WARNING, str(seen[0].message)
    elif outcome is Outcome.ACCEPTED:
        outcome, detail = judged_reading(changed.allowed, read[0] == original, out.getvalue())
    return Attempt(number, outcome, f"{changed.how}: {detail}", seconds)


def judged(kind: Kind, code: int, said: list[str], folder: Path) -> tuple[Outcome, str]:
    """Of the exit code and what was said on stderr."""
    first = said[0] if said else ""
    if code in (UNFORESEEN, MACHINE_FAULT):
        return (Outcome.TRACEBACK if code == UNFORESEEN else Outcome.MEMORY), first
    for line in said:
        if not line.isprintable() or len(line) > LONGEST:
            return Outcome.NO_LINE, f"{len(line)} letters: {line[:LONGEST]!r}"
    if code == OK:
        return Outcome.ACCEPTED, ""
    if code != kind.code or not said:
        return Outcome.WRONG_CODE, f"{code}: {first}"
    for line in said:
        if str(folder / kind.attacked) not in line and not re.match(f"and .* more faults|{kind.elsewhere}", line):
            return Outcome.WRONG_FILE, line
    return Outcome.REFUSED, first


def judged_reading(allowed: Reading, same: bool, printed: str) -> tuple[Outcome, str]:
    """Of what was read, and printed on stdout."""
    if {Reading.ANY: False, Reading.SAME: not same, Reading.OTHER: same, Reading.NONE: True}[allowed]:
        return Outcome.MISREAD, f"it may read as {allowed}"
    for line in printed.split("\n"):
        if not line.isprintable():
            return Outcome.NO_LINE, f"printed: {line!r}"
    return Outcome.ACCEPTED, ""
