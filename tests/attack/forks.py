"""A command in a fork of this process, which has loaded all that it needs: it begins at once, and may be killed."""

from __future__ import annotations

import os
import resource
import signal
import sys
import time
from collections.abc import Mapping, Sequence
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from synth.cli import main
from tests.golden.orders import ORDERS
from tests.golden.record import recorded, write_inputs

FEWEST_S: Final = 0.002
"""Between two looks at the process."""


@dataclass(frozen=True)
class Ended:
    """How a command ended: its exit code, below 0 the signal that ended it; what it said; how long it took."""

    code: int
    out: str
    err: str
    seconds: float


@dataclass(frozen=True)
class Stroke:
    """A signal that a command gets so long after its begin."""

    after_s: float
    number: int = signal.SIGKILL


@dataclass(frozen=True)
class Limits:
    """Seconds by the clock and of the processor after which it is killed; address space; length of a file."""

    clock_s: float = 900.0
    processor_s: int = 60
    memory_bytes: int | None = None
    file_bytes: int | None = None


def prepared(folder: Path) -> None:
    """Run the golden commands in `folder`, but those whose results are there."""
    folder.mkdir(parents=True, exist_ok=True)
    write_inputs(folder)
    for order in ORDERS:
        if order.output and not (folder / order.output).exists():
            recorded(order, folder)


def warmed(words: Sequence[str], folder: Path) -> int:
    """Give the command in this process, so that its forks have loaded all that it needs; its exit code."""
    before = Path.cwd()
    os.chdir(folder)
    try:
        with (folder / ".out").open("w") as out, redirect_stdout(out), redirect_stderr(out):
            return main(list(words))
    finally:
        os.chdir(before)


def forked(words: Sequence[str], folder: Path, stroke: Stroke | None = None, limits: Limits | None = None) -> Ended:
    """Give the command `words` in `folder`."""
    out, err = folder / ".out", folder / ".err"
    hears, tells = os.pipe()
    child = os.fork()
    if child == 0:
        run(words, folder, (out, err), limits or Limits(), tells)
    os.close(tells)
    os.read(hears, 1)  # from here on it is the command that a stroke hits
    os.close(hears)
    started = time.monotonic()
    ends: list[tuple[float, int]] = [(started + (limits or Limits()).clock_s, signal.SIGKILL)]
    ends += [] if stroke is None else [(started + stroke.after_s, stroke.number)]
    while True:
        pid, status = os.waitpid(child, os.WNOHANG)
        if pid:
            break
        for end in [each for each in ends if time.monotonic() >= each[0]]:
            os.kill(child, end[1])
            ends.remove(end)
        time.sleep(FEWEST_S)
    seconds = time.monotonic() - started
    code = os.waitstatus_to_exitcode(status)
    return Ended(code, out.read_text(errors="replace"), err.read_text(errors="replace"), seconds)


def run(words: Sequence[str], folder: Path, streams: Sequence[Path], limits: Limits, tells: int) -> None:
    """The child: it never returns; before it begins it writes to the descriptor `tells`."""
    code = 99
    try:
        os.setpgid(0, 0)
        for number, path in enumerate(streams, start=1):
            os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), number)
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        os.chdir(folder)
        limit(limits)
        os.write(tells, b"x")
        code = main(list(words))
        sys.stdout.flush()
        sys.stderr.flush()
    except BaseException:  # nothing of the parent may run on in the child
        import traceback

        os.write(2, traceback.format_exc().encode())
    finally:
        os._exit(code)


def limit(limits: Limits) -> None:
    """Set the limits of this process."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    most_s = int(used.ru_utime + used.ru_stime) + limits.processor_s
    bounds = {
        resource.RLIMIT_CPU: most_s, resource.RLIMIT_AS: limits.memory_bytes, resource.RLIMIT_FSIZE: limits.file_bytes,
    }  # fmt: skip
    for what, most in bounds.items():
        if most is not None:
            resource.setrlimit(what, (most, resource.getrlimit(what)[1]))


def contents(folder: Path) -> Mapping[str, bytes]:
    """Every file below `folder` by name."""
    return {each.relative_to(folder).as_posix(): each.read_bytes() for each in folder.rglob("*") if each.is_file()}
