"""The machine and the software that a qualification holds for."""

from __future__ import annotations

import os
import platform
from collections.abc import Iterator
from typing import Final

from synth.cli.qualification.installed import Installed
from synth.frame.exhibits import Row
from synth.frame.processors import available, processor_name

SETTINGS: Final = ("NUMBA_", "OPENBLAS_", "MKL_", "OMP_", "NPY_", "RETARDER_SYNTH_PLAIN", "PYTHONOPTIMIZE")
"""Beginnings of the names of environment variables that change what is computed, or how."""

OWN: Final = ("NUMBA_CACHE_DIR", "OPENBLAS_NUM_THREADS")
"""Those that the program sets for itself."""


def machine_rows() -> Iterator[Row]:
    """What it is, a fact a row."""
    facts = {
        "name": platform.node(),
        "processor": processor_name(),
        "processors to work on": str(available()),
        "system": platform.platform(),
        "Python": f"{platform.python_implementation()} {platform.python_version()}",
        "settings": " ".join(settings()) or "none that change a computation",
    }
    yield from ({"fact": fact, "value": value} for fact, value in facts.items())


def settings() -> Iterator[str]:
    """Environment variables of the user that change what is computed."""
    named = (name for name in sorted(os.environ) if name.startswith(SETTINGS) and name not in OWN)
    return (f"{name}={os.environ[name]}" for name in named)


def version_rows(found: tuple[Installed, ...]) -> Iterator[Row]:
    """Packages, a row each."""
    for each in found:
        yield {"name": each.name, "version": each.version, "files": each.files, "sha256": each.sha256}
