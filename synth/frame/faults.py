"""What can go wrong: the one error for a fault in what the user gave; faults of the machine, of which neither the
input nor this program is guilty; and an exception that nobody has foreseen.
"""

from __future__ import annotations

import errno
import os
import traceback
from collections.abc import Mapping
from typing import Final


class InputError(ValueError):
    """The input is at fault: one sentence for each fault, with file, key, value, what is allowed, what to do."""

    @property
    def sentences(self) -> tuple[str, ...]:
        """The faults, at least one."""
        return tuple(map(str, self.args))

    def __str__(self) -> str:
        return "\n".join(self.sentences)


def unforeseen(fault: BaseException) -> str:
    """Type, words and place of `fault`, without a line break."""
    frames = traceback.extract_tb(fault.__traceback__)
    place = f" (in {os.path.basename(frames[-1].filename)}, line {frames[-1].lineno})" if frames else ""
    return f"{type(fault).__name__}: {' '.join(str(fault).split()) or 'no words'}{place}"


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
