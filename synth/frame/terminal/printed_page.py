"""The end of a command on stdout, as wide as the terminal: tables laid out for any width without cutting a figure,
sentences and a verdict, broken between words, and inside one only where it is longer than a line.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, TypeAlias

if TYPE_CHECKING:
    from synth.frame.exhibits import Column, Row, Table

SPACE: Final = " "
NO_BREAK: Final = "\u00a0"
"""Printed as a space, but no line is broken there."""

WORD: Final = re.compile(r" *[^ ]+(?:(?<=\d) [%\w/]{1,4}[,;.:)\]]*(?= |$))?")
"""A word with the spaces before it; a number and its unit are one word."""

HANGING: Final = 2
"""How much farther right a sentence goes on."""

BREAKS: Final = "/_-"
"""A word that is longer than a line is broken behind one of these."""


def wrapped(text: str, width: int, hang: int = 0) -> list[str]:
    """The lines of `text`, none longer than `width` characters; those after the first begin `hang` farther right.

    A word is broken only if a line is too short for it, so that every figure that fits into a line stays whole.
    """
    margin = SPACE * min(len(text) - len(text.lstrip(SPACE)) + hang, width // 2)
    lines = [""]
    for token in WORD.findall(text):
        if lines[-1].strip(SPACE) and len(lines[-1] + token) > width:
            lines.append(margin + token.lstrip(SPACE))
        else:
            lines[-1] += token
        word = len(token.lstrip(SPACE))
        while len(lines[-1]) > width:
            line = lines.pop()
            at = place_to_break(line, len(line) - word, width)
            lines += [line[:at], margin + line[at:]]
            word = len(line) - at
    return [line.replace(NO_BREAK, SPACE) for line in lines]


def place_to_break(line: str, begin: int, width: int) -> int:
    """Where to break the word from `begin` on to the end of `line`, so that the line is not longer than `width`."""
    return max((line.rfind(each, begin, width) for each in BREAKS), default=-1) + 1 or width


def least_width(text: str, most_lines: int) -> int:
    """The smallest width at which `text` is broken between words only, and over so many lines at most."""
    width = longest_word(text)
    while len(wrapped(text, width)) > most_lines:
        width += 1
    return width


def longest_word(text: str) -> int:
    """Characters of the longest word."""
    return max((len(word.strip(SPACE)) for word in WORD.findall(text)), default=0)


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


@dataclass(frozen=True)
class PrintedVerdict:
    """Whether the limits are kept, None where that is not decided, and the sentence that says so; in colour where the
    terminal has some."""

    kept: bool | None
    sentence: str


VERDICTS: Final = {
    True: ("accepted", "bold green"),
    False: ("not accepted", "bold red"),
    None: ("not decidable", "bold yellow"),
}
"""Word and style."""

Printed: TypeAlias = PrintedTable | PrintedVerdict | str
"""A string is a sentence, or a few; spaces at its beginning are kept."""


def print_page(*page: Printed) -> None:
    """Print to stdout; where that is no terminal, nothing is left out and no line is broken."""
    from rich.console import Console
    from rich.text import Text

    console = Console(highlight=False, soft_wrap=True)
    for line, style in page_lines(page, console.width if console.is_terminal else None):
        console.print(Text(line, style))


def page_lines(page: tuple[Printed, ...], width: int | None) -> Iterator[tuple[str, str]]:
    """Lines, none longer than `width` characters, and their styles; a blank line stands on both sides of a table."""
    for place, exhibit in enumerate(page):
        if isinstance(exhibit, PrintedTable):
            apart = place > 0 and not isinstance(page[place - 1], PrintedTable)  # a table has a blank line below it
            lines = [*[""] * apart, *table_lines(exhibit, width), *[""] * (place < len(page) - 1)]
            yield from ((line, "") for line in lines)
        elif isinstance(exhibit, PrintedVerdict):
            word, style = VERDICTS[exhibit.kept]
            yield from ((line, style) for line in sentence_lines(f"{word}: {exhibit.sentence}", width))
        else:
            yield from ((line, "") for line in sentence_lines(exhibit, width))


def sentence_lines(text: str, width: int | None) -> list[str]:
    """A sentence over as many lines as it needs."""
    return [text] if width is None else wrapped(text, width, HANGING)
