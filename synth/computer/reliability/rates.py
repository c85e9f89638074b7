"""Rates and shares that reliability models take: what is allowed, and how many hours a year has."""

from __future__ import annotations

HOURS_PER_YEAR = 8760.0
"""24 · 365, as [hump-computer-1970s] counts them."""
