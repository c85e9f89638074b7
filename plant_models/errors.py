"""The one error that the plant raises for an impossible physical value."""

from __future__ import annotations

import math


class PlantError(ValueError):
    """A physical value is outside what the models mean; the message is one sentence for the user."""


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
