"""Faults of the machine, of which neither the input nor this program is guilty: what to do about each."""

from __future__ import annotations

import errno
from collections.abc import Mapping
from typing import Final

MACHINE_FAULTS: Final[Mapping[int, str]] = {
    errno.ENOSPC: "make room on that disk, then run the command again",
    errno.EDQUOT: "make room within your quota, then run the command again",
    errno.EFBIG: "raise the limit of a file's size (ulimit -f), then run the command again",
    errno.EIO: "check the disk, then run the command again",
    errno.EMFILE: "raise the limit of open files (ulimit -n), then run the command again",
    errno.ENFILE: "close other programs, then run the command again",
    errno.ENOMEM: "free memory or raise the limit of it (ulimit -v), then run the command again",
    errno.EAGAIN: "wait a little or raise the limit of processes (ulimit -u), then run the command again",
}
"""What to do, by the number of an `OSError`."""
