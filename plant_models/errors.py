"""The one error that the plant raises for an impossible physical value, and the hint that ends a message about an
unknown name.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from difflib import get_close_matches


class PlantError(ValueError):
    """A physical value is outside what the models mean; the message is one sentence for the user."""


class Faults(PlantError):
    """All that is at fault in one thing, a sentence each; at least one."""

    def __init__(self, *sentences: str) -> None:
        super().__init__("; ".join(sentences))
        self.sentences = sentences


def require_none(sentences: Iterable[str]) -> None:
    """Raise `Faults` unless there are no `sentences`, each of which tells a fault."""
    found = tuple(sentences)
    if found:
        raise Faults(*found)


def require(holds: bool, sentence: str) -> None:
    """Raise `PlantError(sentence)` unless `holds`."""
    if not holds:
        raise PlantError(sentence)


def require_between(name: str, value: float, low: float, high: float) -> None:
    """Raise `PlantError` unless `value` is a finite number in [low, high]."""
    require(
        math.isfinite(value) and low <= value <= high,
        f"{name} is {value!r}; it must be a finite number from {low:g} to {high:g}",
    )


def near_miss(word: str, choices: Iterable[str]) -> str:
    """'did you mean X?' if one of `choices` begins with `word` or is close to it, else 'known: A, B, C'."""
    known = sorted(choices)
    meant = close_name(word, known)
    return f"known: {', '.join(known)}" if meant is None else f"did you mean {meant}?"


def close_name(word: str, choices: Iterable[str]) -> str | None:
    """The shortest of `choices` that begins with `word`, or the closest to it; None if none is close."""
    known = sorted(choices)
    begun = sorted((name for name in known if len(word) >= 3 and name.startswith(word)), key=len)
    close = begun or get_close_matches(word, known, n=1, cutoff=0.6)
    return close[0] if close else None
