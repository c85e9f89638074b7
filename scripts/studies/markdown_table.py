"""A table of the documentation: heads and rows of text, and numbers as such tables show them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

Interval = tuple[float, float]
"""Low and high end."""

ABSENT = "–"


@dataclass(frozen=True)
class MarkdownTable:
    """What a table tells (one sentence), its heads, its rows; every row has as many cells as there are heads."""

    title: str
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.heads):
                raise ValueError(f"table {self.title!r}: {len(row)} cells under {len(self.heads)} heads: {row}")

    def markdown(self) -> str:
        """The lines of the table, each with its end; the title is not in them."""
        lines = (self.heads, ("---",) * len(self.heads), *self.rows)
        return "".join(f"| {' | '.join(cells)} |\n" for cells in lines)


def table(title: str, heads: Iterable[str], rows: Iterable[Iterable[str]]) -> MarkdownTable:
    """The table of these heads and rows."""
    return MarkdownTable(title, tuple(heads), tuple(tuple(row) for row in rows))


def around(value: float, ends: Sequence[float], digits: int = 4, scale: float = 1.0) -> str:
    """'0.0419 [0.0414, 0.0425]': a figure with its interval, both times `scale`."""
    return f"{scale * value:.{digits}f} {span(ends, digits, scale)}"


def span(ends: Sequence[float], digits: int = 4, scale: float = 1.0) -> str:
    """'[0.0414, 0.0425]': an interval."""
    low, high = ends
    return f"[{scale * low:.{digits}f}, {scale * high:.{digits}f}]"


def plus_minus(value: float, ends: Sequence[float], digits: int, scale: float = 1.0) -> str:
    """'41.50 ± 0.28': a figure and half the width of its interval."""
    low, high = ends
    return f"{scale * value:.{digits}f} ± {0.5 * scale * (high - low):.{digits}f}"
