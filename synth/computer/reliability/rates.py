"""Rates and shares that reliability models take: what is allowed, and how many hours a year has."""

from __future__ import annotations

import math

from plant_models.errors import require

HOURS_PER_YEAR = 8760.0
"""24 · 365, as [hump-computer-1970s] counts them."""


def require_positive(name: str, value: float) -> None:
    """Raise `PlantError` unless `value` is finite and above 0."""
    require(math.isfinite(value) and value > 0.0, f"{name} is {value!r}; it must be a finite number above 0")


def require_not_negative(name: str, value: float) -> None:
    """Raise `PlantError` unless `value` is finite and not below 0."""
    require(math.isfinite(value) and value >= 0.0, f"{name} is {value!r}; it must be a finite number, 0 or more")
