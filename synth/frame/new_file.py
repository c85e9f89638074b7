"""A single file that a command is asked for by name, among files that it knows nothing of."""

from __future__ import annotations

import os
from pathlib import Path

from synth.frame.input_error import InputError


def require_new(path: Path) -> None:
    """`InputError` if there is something at `path`: no command overwrites what it did not write."""
    if os.path.lexists(path):
        raise InputError(f"{path}: it is there already, and is not overwritten; give another name, or move it away")
