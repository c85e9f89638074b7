"""One step of the release check: what it found, or the fault that a release must not have."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path


class ReleaseFault(Exception):
    """Why this is no release yet, in a sentence or two."""


@dataclass(frozen=True)
class Step:
    """A step by its name; `run` says what it found, or raises `ReleaseFault`."""

    name: str
    run: Callable[[], str]

    def told(self) -> bool:
        """Run it and print what came of it; whether it holds."""
        began = time.monotonic()
        try:
            found, word = self.run(), "ok"
        except ReleaseFault as fault:
            found, word = str(fault), "FAILED"
        print(f"{self.name:14} {word:6} {time.monotonic() - began:4.0f} s   {found}", flush=True)
        return word == "ok"


def ran(command: Sequence[str | Path], folder: Path, surroundings: Mapping[str, str] | None = None) -> str:
    """What `command` prints, run in `folder` with these environment variables alone, or with ours; `ReleaseFault`."""
    words = [str(word) for word in command]
    done = subprocess.run(words, cwd=folder, env=surroundings, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        said = "\n".join(f"{done.stdout}\n{done.stderr}".strip().splitlines()[-20:])
        raise ReleaseFault(f"{' '.join(words)} in {folder}: exit code {done.returncode}\n{said}")
    return done.stdout
