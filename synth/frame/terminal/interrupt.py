"""Ctrl-C or SIGTERM: this process ends at once and leaves no unfinished file."""

from __future__ import annotations

import contextlib
import signal
import threading
from collections.abc import Iterator
from types import FrameType
from typing import TYPE_CHECKING, Final

from synth.frame.terminal.telling import INTERRUPTED, leave, say

if TYPE_CHECKING:
    from synth.frame.results_directory import ResultsDirectory


ENDING: Final = (signal.SIGINT, signal.SIGTERM)
"""Signals by which a user, or a scheduler of jobs, asks a run to end."""


@contextlib.contextmanager
def interruptible(directory: ResultsDirectory | None = None, result: str = "book") -> Iterator[None]:
    """Within, these signals end the process with code 130, as `leave` does; told of is the `directory` of its `result`.

    Not by an exception: it would wait for threads that compute for seconds and cannot be told to stop, and Python drops
    one that is raised where an object is given up.
    """
    if threading.current_thread() is not threading.main_thread():  # only the main thread may take signals
        yield
        return

    def end(number: int, frame: FrameType | None) -> None:
        for each in ENDING:
            signal.signal(each, signal.SIG_IGN)
        said = "interrupted" if directory is None else f"interrupted; {directory.path} holds no complete {result}"
        on = directory is not None and directory.goes_on
        with contextlib.suppress(OSError, RuntimeError, ValueError):  # stderr may be in the middle of a line
            say(f"{said}, but what the same command goes on from" if on else said)
        leave(INTERRUPTED)

    before = {each: signal.signal(each, end) for each in ENDING}
    try:
        yield
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)


@contextlib.contextmanager
def interrupts_ignored() -> Iterator[None]:
    """Within, SIGINT is ignored, also by processes that are started."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
