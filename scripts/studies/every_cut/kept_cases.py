"""Finished cases in a file, so that a run that was stopped goes on where it was.

What is kept holds for this very software alone. Every case is a line, on the disk as soon as it is known; a line that a
process was killed in is passed over.
"""

from __future__ import annotations

import hashlib
import threading
from collections.abc import Callable
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter

from scripts.studies.every_cut.cut_figures import Outcome
from scripts.studies.result import plain
from synth.frame.workers.software import software_sha256
from synth.retarder.sweep.ledger import DONE, LedgerWriter, read_ledger

FILE = "every-cut.jsonl"


class KeptCases:
    """The cases in the file `path`, which need not be there; any thread may ask."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._lock = threading.Lock()
        self._known: dict[str, Any] = {each["key"]: each["outcome"] for each in read_ledger(path).of(DONE)}

    def outcome_of(self, text: str, make: Callable[[], Outcome]) -> Outcome:
        """The outcome of the configuration `text` if it is kept, else what `make` finds; that is kept."""
        key = key_of(text)
        if key in self._known:
            found: Outcome = TypeAdapter(Outcome).validate_python(self._known[key])
            return found
        found = make()
        with self._lock, LedgerWriter(self._path) as ledger:
            ledger.write(DONE, {"key": key, "outcome": plain(asdict(found))})
        return found


def key_of(text: str) -> str:
    """64 hex digits of a configuration and of everything that its outcome depends on besides."""
    return hashlib.sha256(f"{software_sha256()}\0{studies_sha256()}\0{text}".encode()).hexdigest()


@cache
def studies_sha256() -> str:
    """64 hex digits that change with any source of a study: the software itself does not know of them."""
    folder = Path(__file__).resolve().parents[1]
    digest = hashlib.sha256()
    for path in sorted(folder.rglob("*.py")):
        content = path.read_bytes()
        digest.update(f"\0{path.relative_to(folder).as_posix()}\0{len(content)}\0".encode() + content)
    return digest.hexdigest()
