"""The hint that ends a message about an unknown name."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches


def near_miss(word: str, choices: Iterable[str]) -> str:
    """'did you mean X?' if one of `choices` begins with `word` or is close to it, else 'known: A, B, C'."""
    known = sorted(choices)
    begun = [name for name in known if len(word) >= 3 and name.startswith(word)]
    close = begun or get_close_matches(word, known, n=1, cutoff=0.6)
    return f"did you mean {close[0]}?" if close else f"known: {', '.join(known)}"
