"""Ctrl-C while threads compute: the process ends at once and leaves no unfinished file."""

from __future__ import annotations

import contextlib
import signal
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from types import FrameType

from synth.cli import INTERRUPTED, leave, say


@contextlib.contextmanager
def interruptible(directory: Path | None = None, result: str = "book") -> Iterator[None]:
    """Within, Ctrl-C ends the process with code 130, after removing unfinished files from `directory`.

    Not by an exception: it would wait for threads that compute for seconds and cannot be told to stop.
    """
    if threading.current_thread() is not threading.main_thread():  # only the main thread may take signals
        yield
        return

    def end(number: int, frame: FrameType | None) -> None:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        if directory is not None:
            from synth.book.output_directory import remove_leftovers

            with contextlib.suppress(OSError):
                remove_leftovers(directory)
        say("interrupted" if directory is None else f"interrupted; {directory} holds no complete {result}")
        with contextlib.suppress(OSError, ValueError):
            sys.stdout.flush()
        leave(INTERRUPTED)

    before = signal.signal(signal.SIGINT, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
