"""The comparison of one export, and what became of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from synth.checker.finding import DamagedError, Finding, Kind

Differences = Iterator[tuple[str, str]]
"""(about, sentence): the id of a table, "" for the export itself."""

Check = Callable[[Path, Callable[[], Differences]], None]
"""Compares the export in a file by the function, and keeps what was found."""


def findings_of(name: str, compare: Callable[[], Differences]) -> Iterator[Finding]:
    """What the comparison of the export called `name` finds."""
    try:
        for about, sentence in compare():
            yield Finding(Kind.DISAGREES, about or name, f"{name}: {sentence}" if about else sentence)
    except DamagedError as fault:
        yield Finding(Kind.DAMAGED, name, str(fault))
