"""Attempts in processes that have limits: one that hangs, takes all memory or crashes ends its process alone."""

from __future__ import annotations

import contextlib
import io
import math
import multiprocessing
import os
import resource
import signal
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Final

from tests.attack.attempt import Attempt, Kind, Outcome, attempted

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
