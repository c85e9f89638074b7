"""A table on the terminal, laid out for any width without cutting a figure."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:  # it has numpy
    from synth.frame.exhibits import Column, Row, Table

from synth.frame.terminal.printed_words import HANGING, least_width, longest_word, wrapped

IN_JSON: Final = "the output of --json"
"""Where the figures are of a command that only reads."""

GAP = "  "
"""Between two columns."""

HEADING_LINES = 3
"""A heading is wrapped over so many lines at most."""

READABLE = 24
"""Words in a cell are not wrapped to fewer characters."""


@dataclass(frozen=True)
class PrintedTable:
    """`table` as a terminal has it; `elsewhere` names the place of the figures that a narrow one has no room for."""

    table: Table
    elsewhere: str

    @property
    def columns(self) -> tuple[Column, ...]:
        """Those that a terminal may show."""
        return tuple(column for column in self.table.seen if not column.detail)


@dataclass(frozen=True)
class Filled:
    """A column with its cells; `least` is the smallest width that it can have, `natural` the width that it likes."""

    heading: str
    cells: tuple[str, ...]
    words: bool
    once: bool
    spare: int

    @property
    def least(self) -> int:
        """Figures whole, words over a few lines."""
        cells = (min(len(cell), max(READABLE, longest_word(cell))) if self.words else len(cell) for cell in self.cells)
        return max([least_width(self.heading, HEADING_LINES), *cells])

    @property
    def natural(self) -> int:
        """Every cell on one line."""
        return max([self.least, *map(len, self.cells)])


def table_lines(printed: PrintedTable, width: int | None) -> list[str]:
    """The lines of a table, none longer than `width` characters; None: as wide as all columns need.

    Columns are left out by their `spare` until the others fit, which the last line then tells. If the columns without
    a `spare` do not fit either, the rows are stacked: a line `heading: value` for each column, and nothing left out.
    """
    table, filled = printed.table, [fill(column, printed.table.rows) for column in printed.columns]
    kept = fitting(filled, width)
    lines = list(laid_out(kept, widths_of(kept, width)) if kept else stacked(filled))
    if 0 < len(kept) < len(filled):
        lines.append(
            f"The terminal is too narrow for {len(filled) - len(kept)} of {len(filled)} columns; every figure is in "
            f"{printed.elsewhere}."
        )
    told = [table.title, *lines] if table.title else lines
    return told if width is None else [part for line in told for part in wrapped(line, width, HANGING)]


def fill(column: Column, rows: Sequence[Row]) -> Filled:
    """The column with the cells of all rows."""
    return Filled(column.title, tuple(column.brief(row) for row in rows), column.words, column.once, column.spare)


def fitting(columns: Sequence[Filled], width: int | None) -> list[Filled]:
    """The columns that fit side by side into `width`; none if not even those fit that have to stay."""
    kept = list(columns)
    while width is not None and line_width(column.least for column in kept) > width:
        spare = max(reversed(kept), key=lambda column: column.spare)
        if not spare.spare:
            return []
        kept.remove(spare)
    return kept


def widths_of(columns: Sequence[Filled], width: int | None) -> list[int]:
    """Of each column: what it likes, and where that is too much for `width` the widest words are wrapped."""
    widths = [column.natural for column in columns]
    while width is not None and line_width(widths) > width:
        shrinking = (place for place, column in enumerate(columns) if widths[place] > column.least)
        widths[max(shrinking, key=lambda place: widths[place])] -= 1
    return widths


def line_width(widths: Iterator[int] | Sequence[int]) -> int:
    """Characters of a line with columns of these widths."""
    each = tuple(widths)
    return sum(each) + len(GAP) * (len(each) - 1)


def laid_out(columns: Sequence[Filled], widths: Sequence[int]) -> Iterator[str]:
    """Headings, a rule with a piece for each column, and the rows."""
    heads = [wrapped(column.heading, width) for column, width in zip(columns, widths, strict=True)]
    deepest = max(map(len, heads))
    yield from side_by_side([[""] * (deepest - len(head)) + head for head in heads], columns, widths)
    yield GAP.join("─" * width for width in widths)
    shown = without_repeats(columns)
    for row in zip(*shown, strict=True):
        parts = [
            wrapped(cell, width) if column.words else [cell]
            for cell, column, width in zip(row, columns, widths, strict=True)
        ]
        yield from side_by_side(parts, columns, widths)


def side_by_side(cells: Sequence[list[str]], columns: Sequence[Filled], widths: Sequence[int]) -> Iterator[str]:
    """The lines of some cells beside each other."""
    for line in range(max(map(len, cells))):
        parts = [cell[line] if line < len(cell) else "" for cell in cells]
        yield GAP.join(
            f"{part:<{width}}" if column.words else f"{part:>{width}}"
            for part, column, width in zip(parts, columns, widths, strict=True)
        ).rstrip()


def without_repeats(columns: Sequence[Filled]) -> list[tuple[str, ...]]:
    """The cells of all columns, blank where `once` says so."""
    leading: list[tuple[str, ...]] = []
    shown = []
    for column in columns:
        if not column.once:
            shown.append(column.cells)
            continue
        leading.append(column.cells)
        rows = list(zip(*leading, strict=True))
        above = [None, *rows]
        shown.append(tuple("" if row == before else row[-1] for row, before in zip(rows, above, strict=False)))
    return shown


def stacked(columns: Sequence[Filled]) -> Iterator[str]:
    """For each row its first cell, and below it a line for each other column."""
    first, *others = columns
    for place, cell in enumerate(first.cells):
        yield f"{first.heading}: {cell}"
        for column in others:
            yield f"  {column.heading}: {column.cells[place]}"
