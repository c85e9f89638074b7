"""How many processors there are to work on."""

from __future__ import annotations

import os


def available() -> int:
    """Processors that this process may use; where the system does not tell (macOS), all of them."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
