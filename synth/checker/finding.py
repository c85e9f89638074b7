"""What is wrong with a table or an export, in one sentence, and what became of one comparison."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum
from pathlib import Path


class Kind(Enum):
    """What a finding is about; the value is its name for programs."""

    DAMAGED = "damaged"
    """A file is broken, or its content makes no table."""
    DISAGREES = "disagrees"
    """Two files that should say the same do not."""
    CLAIM = "claim"
    """A figure of quality was not confirmed."""


@dataclass(frozen=True)
class Finding:
    """One fault; `about` is the id of a table or the path of a file."""

    kind: Kind
    about: str
    sentence: str


class DamagedError(Exception):
    """A file cannot be used at all; the message is one sentence without the file's name."""


class NothingToVerifyError(Exception):
    """There is nothing to read where the user pointed; the message is one sentence."""


def shown(value: object) -> str:
    """`value` for a message, at most 60 characters of it."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


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
