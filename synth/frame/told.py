"""A finished run as a value: all that its page, its summary and its print are made of."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from synth.frame.command import Head, Verdict
from synth.frame.exhibits import Chapter, Chart, Exhibit, File, Sentence, Table, exhibits_of


@dataclass(frozen=True)
class Told:
    """`command`: its name; `created`: UTC instant; `limits_of_use`: what the figures do not say.

    `ValueError` where two figures, tables, charts or files have one name: one of them would be lost.
    """

    command: str
    head: Head
    created: str
    verdict: Verdict
    chapters: tuple[Chapter, ...]
    limits_of_use: Sequence[str]

    def __post_init__(self) -> None:
        names = [name for each in exhibits_of(self.chapters) for name in names_of(each)]
        twice = sorted(name for name, count in Counter(names).items() if count > 1)
        if twice:
            raise ValueError(f"'{self.command}' shows twice: {', '.join(' '.join(name) for name in twice)}")


def names_of(exhibit: Exhibit) -> Iterator[tuple[str, str]]:
    """(kind, name) of all that `exhibit` is kept under."""
    match exhibit:
        case Sentence():
            yield from (("figure", name) for name in exhibit.figures)
        case Table():
            yield "table", exhibit.name
        case Chart():
            yield "chart", exhibit.name
        case File():
            yield "file", exhibit.name
