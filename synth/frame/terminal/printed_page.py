"""The end of a command on stdout: tables, sentences and a verdict, as wide as the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, TypeAlias

from synth.frame.terminal.printed_table import PrintedTable, table_lines
from synth.frame.terminal.printed_words import HANGING, wrapped


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
