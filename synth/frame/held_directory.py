"""One run at a time holds a directory.

The lock is on the directory itself and the kernel's: no lock file is left, and it ends with the process, however that
ends. A file system without locks holds nobody back.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Final

TRIES: Final = 10
PAUSE_S: Final = 0.05
"""The lock is asked for so often: `is_held` takes it for a moment to see whether it is free."""


@contextlib.contextmanager
def held(path: Path) -> Iterator[int | None]:
    """Hold the directory `path`, open under the descriptor handed out; None where another run holds it."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        yield descriptor if locked(descriptor) else None
    finally:
        os.close(descriptor)


def locked(descriptor: int) -> bool:
    """Lock the open directory for this process; True also on a file system without locks."""
    for _ in range(TRIES):
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            time.sleep(PAUSE_S)
        except OSError:
            return True
        else:
            return True
    return False


def is_held(path: Path) -> bool:
    """Whether a run holds the directory `path` now."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        return False
    finally:
        os.close(descriptor)
    return False
