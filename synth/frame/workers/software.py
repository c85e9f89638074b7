"""What a result depends on besides its configuration: the program itself and the libraries that compute for it."""

from __future__ import annotations

import hashlib
from functools import cache
from importlib.metadata import version
from pathlib import Path

from synth.frame.workers.engine import worker_name
from synth.kernels.cache import compiling_facts

SHOWING = frozenset({"checker", "cli", "page", "picture", "pictures", "shown", "terminal"})
"""Folders and files of what shows or checks results and makes none."""

PATTERNS = ("plant_models/**/*.py", "plant_models/**/*.toml", "synth/**/*.py", "tuning_tables/**/*.py")


@cache
def software_sha256() -> str:
    """64 hex digits that change with any source that can change a table, the versions that compute it, the processor.

    The processor counts because compiled kernels are made for it: another one may round otherwise.
    """
    root = Path(__file__).resolve().parents[3]
    digest = hashlib.sha256(f"{version('retarder-synth')}\0{version('scipy')}\0{compiling_facts()}".encode())
    names = {path.relative_to(root).as_posix(): path for pattern in PATTERNS for path in root.glob(pattern)}
    for name in sorted(names):
        if SHOWING.isdisjoint(Path(name).with_suffix("").parts):
            content = names[name].read_bytes()
            digest.update(f"\0{name}\0{len(content)}\0".encode() + content)
    return digest.hexdigest()


def require_software(sha256: str) -> None:
    """`ValueError` unless this process runs the very software that has asked."""
    if software_sha256() != sha256:
        raise ValueError(
            f"the worker {worker_name()} has another version of retarder-synth or of its libraries, or another "
            "processor, than the run that asked; its results might differ"
        )
