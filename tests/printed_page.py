"""What a command prints at the end, caught as it is handed over, and read back from its lines at any width."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

import pytest

from synth.frame.terminal import printed_page
from synth.frame.terminal.printed_page import Printed, PrintedTable, PrintedVerdict

WIDTHS = (60, 80, 100, 140)
"""Of the terminals that are tried."""

ABSENT = "–"

Page = tuple[Printed, ...]
LinesOf = Callable[[Page, int | None], Iterator[tuple[str, str]]]
Read = list[dict[str, str]]
"""The rows of a table: cells by heading."""


@contextmanager
def caught() -> Iterator[list[Page]]:
    """The pages that are printed within, which are printed all the same; each is found whole at every width."""
    pages: list[Page] = []
    lines_of = printed_page.page_lines

    def caught_lines(page: Page, width: int | None) -> Iterator[tuple[str, str]]:
        pages.append(page)
        require_nothing_cut(page, lines_of)
        return lines_of(page, width)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(printed_page, "page_lines", caught_lines)
        yield pages


def table_of(page: Page) -> Read:
    """The cells of the only table of a page."""
    (table,) = (each for each in page if isinstance(each, PrintedTable))
    return cells_of(table)


def page_about(pages: Sequence[Page], directory: object) -> Page:
    """The first page that ends with the files in `directory`."""
    return next(page for page in pages if str(directory) in str(page[-1:]))


def cells_of(table: PrintedTable) -> Read:
    """What the table was declared to say."""
    return [{plain(column.title): plain(column.brief(row)) for column in table.columns} for row in table.table.rows]


def require_nothing_cut(page: Page, lines_of: LinesOf = printed_page.page_lines) -> None:
    """At every width: no line too long, no ellipsis, every cell and every sentence whole."""
    for width in (*WIDTHS, None):
        for exhibit in page:
            lines = [line for line, _ in lines_of((exhibit,), width)]
            assert all(len(line) <= (width or 1000) for line in lines), (width, lines)
            assert "…" not in "".join(lines)
            if isinstance(exhibit, PrintedTable):
                require_whole_table(exhibit, lines, width)
            else:
                text = exhibit.sentence if isinstance(exhibit, PrintedVerdict) else exhibit
                require_whole_words(text, lines, width or len(text) + 20)


def require_whole_words(text: str, lines: list[str], width: int) -> None:
    """The lines say `text`; a word is broken only where a line is too short for it."""
    printed = " ".join(lines)
    assert "".join(printed.split()).endswith("".join(text.split()))
    assert {word for word in text.split() if len(word) <= width // 2} <= set(printed.split())


def require_whole_table(table: PrintedTable, lines: list[str], width: int | None) -> None:
    """The lines hold the cells of the table, all of them or those of some columns and a sentence about the rest."""
    told = cells_of(table)
    headings = [plain(column.title) for column in table.columns]
    rule = next((number for number, line in enumerate(lines) if "─" in line), None)
    if rule is None:
        assert width is not None
        assert read_stacked(lines, headings, len(told)) == told
        return
    essential = [plain(column.title) for column in table.columns if not column.spare]
    found = read_side_by_side(lines, rule, table)
    kept = list(found[0])
    assert kept == [heading for heading in headings if heading in kept]
    assert set(essential) <= set(kept)
    assert found == [{heading: row[heading] for heading in kept} for row in told]
    left_out = len(headings) - len(kept)
    sentence = f"too narrow for {left_out} of {len(headings)} columns; every figure is in {table.elsewhere}."
    assert (sentence in " ".join(" ".join(lines).split())) == bool(left_out)
    assert width is not None or not left_out


def read_side_by_side(lines: list[str], rule: int, table: PrintedTable) -> Read:
    """The rows of a table with its columns beside each other, by the pieces of the rule below its headings."""
    spans = [(piece.start(), piece.end()) for piece in re.finditer("─+", lines[rule])]
    above, title = lines[:rule], "".join(table.table.title.split())
    while title:
        title = title.removeprefix("".join(above.pop(0).split()))
    headings = [" ".join(" ".join(line[begin:end] for line in above).split()) for begin, end in spans]
    columns = {plain(column.title): column for column in table.columns}
    rows: Read = []
    for line in lines[rule + 1 :]:
        if line.startswith("The terminal is too narrow") or not line.strip():
            break
        parts = {heading: line[begin:end].strip() for heading, (begin, end) in zip(headings, spans, strict=True)}
        assert line.strip() == "  ".join(f"{line[begin:end]}" for begin, end in spans).strip()  # nothing stands between
        if not any(parts[heading] for heading in headings if not columns[heading].words):
            for heading, part in parts.items():  # words that go on
                rows[-1][heading] = f"{rows[-1][heading]} {part}".strip()
            continue
        before = rows[-1] if rows else {}
        rows.append(
            {
                heading: part or (before.get(heading, "") if columns[heading].once else "")
                for heading, part in parts.items()
            }
        )
    return rows


def read_stacked(lines: list[str], headings: list[str], count: int) -> Read:
    """The rows of a table of one line a column, in their order."""
    text = " ".join(" ".join(lines).split())
    pattern = " ".join(f"{re.escape(heading)}:(.*?)" for heading in headings * count)
    found = re.search(f"{pattern}$", text)
    assert found is not None, text
    cells = iter(each.strip() for each in found.groups())
    return [{heading: next(cells) for heading in headings} for _ in range(count)]


def plain(text: str) -> str:
    """Without the spaces that hold words together."""
    return " ".join(text.replace("\u00a0", " ").split())


def require_column(told: Read, heading: str, wanted: Sequence[str | None]) -> None:
    """The cells below `heading` are those wanted; None for one without a figure."""
    assert [row[heading] for row in told] == [ABSENT if each is None else each for each in wanted], heading


def with_half(
    value: float | None, ends: Sequence[float | None] | None, digits: int = 2, scale: float = 1.0
) -> str | None:
    """A figure of the JSON as it has to be printed: rounded, with the wider half of its interval."""
    if value is None or ends is None or ends[0] is None or ends[1] is None:
        return None
    half = max(scale * (value - ends[0]), scale * (ends[1] - value))
    return f"{scale * value:.{digits}f} ±{max(half, 10.0**-digits):.{digits}f}"
