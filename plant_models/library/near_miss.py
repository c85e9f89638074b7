"""The hint that ends a message about an unknown name."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches


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
