"""A long text cut to what a message can show."""

from __future__ import annotations


def excerpt(text: str, longest: int = 60) -> str:
    """`text` itself, or its beginning and its end around "..." where it has more than `longest` (>= 5) characters."""
    if len(text) <= longest:
        return text
    kept = longest - len("...")
    return f"{text[: kept - kept // 2]}...{text[len(text) - kept // 2 :]}"
