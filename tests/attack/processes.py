"""One attempt: a changed file is put before the reader in a process that has limits, and what comes of it is
judged.
"""

from __future__ import annotations

import contextlib
import io
import math
import multiprocessing
import os
import random
import re
import resource
import signal
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from enum import StrEnum
from multiprocessing.connection import Connection
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


CONTEXT: Final = multiprocessing.get_context("forkserver")
CONTEXT.set_forkserver_preload(["tests.attack.kinds"])  # else each process would load all readers
os.environ["OPENBLAS_NUM_THREADS"] = "1"  # as the command line does; a process with threads must not fork
HANGS: Final = (-signal.SIGALRM, -signal.SIGPROF)
BATCH: Final = 100
"""Attempts of a process."""


@dataclass(frozen=True)
class Limits:
    """Of one attempt: seconds by the clock and of the processor; of a process: bytes beside what it begins with."""

    clock_s: float = 100.0
    processor_s: float = 15.0
    memory_bytes: int = 2**30


@dataclass(frozen=True)
class Asked:
    """What the processes are to do; `original`: what the unchanged files read as."""

    kind: Kind
    seed: int
    limits: Limits
    original: str


def attempts(
    kind: Kind, numbers: Sequence[int], seed: int = 0, workers: int = 1, limits: Limits | None = None
) -> Iterator[Attempt]:
    """What came of each of the attempts, in order; `workers` processes at a time."""
    asked = Asked(kind, seed, limits or Limits(), original_reading(kind))
    parts = [numbers[at : at + BATCH] for at in range(0, len(numbers), BATCH)]
    with ThreadPoolExecutor(workers) as pool:
        for found in pool.map(lambda part: list(batch(asked, part)), parts):
            yield from found


def original_reading(kind: Kind) -> str:
    """What the files read as before anything is changed."""
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
        kind.put_into(Path(folder))
        return kind.read(Path(folder))


def batch(asked: Asked, numbers: Sequence[int]) -> Iterator[Attempt]:
    """The attempts, one process after the other: a new one goes on where one was ended."""
    waiting = list(numbers)
    while waiting:
        ours, theirs = CONTEXT.Pipe(duplex=False)
        with tempfile.TemporaryDirectory() as folder, ours:
            process = CONTEXT.Process(target=serve, args=(theirs, asked, waiting, Path(folder)))
            process.start()
            theirs.close()
            with contextlib.suppress(EOFError):
                while waiting:
                    yield ours.recv()
                    waiting.pop(0)
            process.join()
        if waiting:
            outcome = Outcome.HANG if process.exitcode in HANGS else Outcome.CRASH
            yield Attempt(waiting.pop(0), outcome, f"the process ended with {process.exitcode}", math.nan)


def serve(pipe: Connection, asked: Asked, numbers: Sequence[int], folder: Path) -> None:
    """The process: make the attempts, telling of each. The clocks end it, be it inside a library written in C."""
    asked.kind.put_into(folder)
    limit_memory(asked.limits.memory_bytes)
    for number in numbers:
        changed = asked.kind.changed(asked.seed, number)
        set_clocks(asked.limits.clock_s, asked.limits.processor_s)
        found = attempted(asked.kind, number, changed, folder, asked.original)
        set_clocks(0.0, 0.0)
        pipe.send(found)


def set_clocks(clock_s: float, processor_s: float) -> None:
    """Have this process ended after so long; 0: not at all."""
    signal.setitimer(signal.ITIMER_REAL, clock_s)
    signal.setitimer(signal.ITIMER_PROF, processor_s)


def limit_memory(more_bytes: int) -> None:
    """Let this process have so much more memory than now; what it starts may have as much."""
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + more_bytes, hard))
