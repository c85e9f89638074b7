"""How cases are grouped, and what files are called."""

from __future__ import annotations

from collections.abc import Iterable

from synth.retarder.tuned_case import Case


def file_stem(*parts: str) -> str:
    """A file name from words: lower case, letters and digits of any script kept, the rest one hyphen."""
    text = "".join(c if c.isalnum() or c == "." else " " for c in " ".join(parts).lower())
    return "-".join(text.split())


def by_class(cases: Iterable[Case]) -> tuple[tuple[Case, ...], ...]:
    """The cases of each cut class, in the order in which the classes first appear."""
    groups: dict[str, list[Case]] = {}
    for case in cases:
        groups.setdefault(case.label, []).append(case)
    return tuple(tuple(group) for group in groups.values())
