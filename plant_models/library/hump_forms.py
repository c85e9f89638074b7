"""Forms of the values in a hump file: each turns a raw value into what it means, or gives None."""

from __future__ import annotations

from typing import Final

from plant_models.library.data_file import number, pairs

LONGEST_NAME: Final = 24
"""Characters; a longer name leaves no room on a plan."""


def text(raw: object) -> str | None:
    """A non-empty string of printable characters."""
    return raw if isinstance(raw, str) and raw and raw.isprintable() else None


def short_text(raw: object) -> str | None:
    """A non-empty string of at most 24 printable characters."""
    found = text(raw)
    return found if found is not None and len(found) <= LONGEST_NAME else None


def texts(raw: object) -> tuple[str, ...] | None:
    """A list of non-empty strings of printable characters."""
    items = [text(x) for x in raw] if isinstance(raw, list) else [None]
    return tuple(x for x in items if x is not None) if None not in items else None


def whole(raw: object) -> int | None:
    """A whole number."""
    return raw if isinstance(raw, int) and not isinstance(raw, bool) else None


def wholes(raw: object) -> tuple[int, ...] | None:
    """A list of whole numbers."""
    items = [whole(x) for x in raw] if isinstance(raw, list) else [None]
    return tuple(x for x in items if x is not None) if None not in items else None


def truth(raw: object) -> bool | None:
    """True or false."""
    return raw if isinstance(raw, bool) else None


def some_numbers(raw: object) -> tuple[float, ...] | None:
    """A list of finite numbers."""
    items = [number(x) for x in raw] if isinstance(raw, list) else [None]
    return tuple(x for x in items if x is not None) if None not in items else None


def triples(raw: object) -> tuple[tuple[float, float, float], ...] | None:
    """A list of [from_m, to_m, turn_deg], each of three finite numbers."""
    items = [some_numbers(x) for x in raw] if isinstance(raw, list) else [None]
    rows = [(x[0], x[1], x[2]) for x in items if x is not None and len(x) == 3]
    return tuple(rows) if len(rows) == len(items) else None


def some_pairs(raw: object) -> tuple[tuple[float, float], ...] | None:
    """A list of pairs of finite numbers."""
    return () if raw == [] else pairs(raw)
