"""The one error that the plant raises for an impossible physical value."""

from __future__ import annotations

import math
from collections.abc import Iterable


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
