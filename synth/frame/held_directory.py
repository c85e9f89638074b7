"""One run at a time holds a directory.

The lock is that of the system on a file in the directory, so it ends with the process, however that ends. The file goes
with the run; one that a killed run has left holds nobody back, and neither does a file system without locks.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from filelock import FileLock, Timeout

LOCK: Final = ".retarder-synth.lock"
"""Name of the file."""

PATIENCE_S: Final = 0.5
"""The lock is asked for so long: `is_held` takes it for a moment to see whether it is free."""


@contextlib.contextmanager
def held(path: Path) -> Iterator[bool]:
    """Hold the directory `path` within; False where another run holds it."""
    lock = FileLock(path / LOCK, timeout=PATIENCE_S, thread_local=False)
    try:
        lock.acquire()
    except Timeout:
        yield False
        return
    except OSError:  # a file system without locks
        yield True
        return
    try:
        yield True
    finally:
        with contextlib.suppress(OSError):  # Windows removes it after the release, not before
            (path / LOCK).unlink()
        lock.release()


def is_held(path: Path) -> bool:
    """Whether a run holds the directory `path` now; False where the system does not let us ask."""
    if not (path / LOCK).exists():
        return False
    lock = FileLock(path / LOCK, timeout=0.0, thread_local=False)
    try:
        lock.acquire()
    except Timeout:
        return True
    except OSError:
        return False
    lock.release()
    return False
