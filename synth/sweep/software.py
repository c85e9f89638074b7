"""What a result depends on besides its configuration: the program itself and the libraries that compute for it."""

from __future__ import annotations

import hashlib
from functools import cache
from importlib.metadata import version
from pathlib import Path

from synth.kernels.cache import compiling_facts

WITHOUT_RESULTS = ("synth/checker/", "synth/cli/", "synth/book/pictures/", "synth/book/shown/")
"""Parts that show or check results and make none."""

PATTERNS = ("plant_models/**/*.py", "plant_models/**/*.toml", "synth/**/*.py", "tuning_tables/**/*.py")


@cache
def software_sha256() -> str:
    """64 hex digits that change with any source that can change a table, the versions that compute it, the processor.

    The processor counts because compiled kernels are made for it: another one may round otherwise.
    """
    root = Path(__file__).resolve().parents[2]
    digest = hashlib.sha256(f"{version('retarder-synth')}\0{version('scipy')}\0{compiling_facts()}".encode())
    names = {path.relative_to(root).as_posix(): path for pattern in PATTERNS for path in root.glob(pattern)}
    for name in sorted(names):
        if not name.startswith(WITHOUT_RESULTS):
            content = names[name].read_bytes()
            digest.update(f"\0{name}\0{len(content)}\0".encode() + content)
    return digest.hexdigest()
