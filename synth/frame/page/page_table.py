"""Tables on a page: as many columns as a screen has room for, what is more behind a fold; and every parameter with
its origin, assumed ones marked in words and colour.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import takewhile
from typing import Final

from plant_models.library import SourcedValue, Value, sources_cited_in
from synth.frame.exhibits import Column, Row, Table
from synth.frame.page.markup import Cell, Markup, element, fold, head_row, joined, table
from synth.frame.printed_numbers import ABSENT, counted

MOST_COLUMNS: Final = 9
"""A reader of a screen of 1300 points sees so many without scrolling."""

MOST_NAMED: Final = 6
"""Headings that a fold tells of what it holds."""

MOST_ROWS: Final = 24
"""A longer table stands behind a fold as a whole."""


def table_or_words(of: Table) -> Markup:
    """The table under its title, or a sentence about one that is empty or too long for a page."""
    heading = element("h3", of.title)
    if not of.rows:
        return joined((heading, element("p", "None.")))
    if of.long:
        return joined((heading, element("p", f"{len(of.rows)} rows in {of.file}.")))
    if len(of.rows) > MOST_ROWS:
        return fold(f"{of.title}: {counted(len(of.rows), 'row')}", *parts(of))
    return joined((heading, *parts(of)))


def parts(of: Table) -> list[Markup]:
    """The columns that come first, and a fold with all others."""
    first, more = on_screen(of.seen)
    shown = [shown_table(of, first)]
    if more:
        names = naming(of.seen)
        room = max(MOST_COLUMNS - len(names), 1)
        parts = [(*names, *more[start : start + room]) for start in range(0, len(more), room)]
        tables = (shown_table(of, columns) for columns in parts)
        shown.append(fold(f"{counted(len(more), 'more figure')} of each row: {listed(more)}", *tables))
    return shown


def on_screen(columns: Sequence[Column]) -> tuple[tuple[Column, ...], tuple[Column, ...]]:
    """All of `columns`, or `MOST_COLUMNS` at most and the rest: details, then those that a reader can spare most."""
    if len(columns) <= MOST_COLUMNS:
        return tuple(columns), ()
    kept = [column for column in columns if not column.detail] or list(columns)
    while len(kept) > MOST_COLUMNS:
        kept.remove(max(reversed(kept), key=lambda column: column.spare))
    return tuple(kept), tuple(column for column in columns if column not in kept)


def naming(columns: Sequence[Column]) -> tuple[Column, ...]:
    """The columns that say which row it is: those that are told once, and the one behind them."""
    once = tuple(takewhile(lambda column: column.once, columns))
    return tuple(columns[: len(once) + 1])


def listed(columns: Sequence[Column]) -> str:
    """Their headings, the first of many."""
    names = [*dict.fromkeys(column.heading for column in columns)]
    return ", ".join(names if len(names) <= MOST_NAMED else [*names[:MOST_NAMED], "…"])


def shown_table(of: Table, columns: Sequence[Column]) -> Markup:
    """The rows with these columns."""
    rows = (([cell(column, row) for column in columns], "bad" if of.bad(row) else "") for row in of.rows)
    return table(of.title, (head_row(*(column.title for column in columns)),), rows, kind="cases")


def cell(column: Column, row: Row) -> Cell:
    """One figure, its interval by the wider half, the whole of it as a tool tip; or words."""
    kind = "words" if column.words else "meta" if column.grey(row.get(column.key)) else ""
    brief, whole = column.brief(row), column.text(row)
    return Cell(brief, "" if brief == whole else whole, kind)


COLUMNS = ("key", "value", "unit", "sensible range", "origin", "confidence", "")


def parameter_section(parameters: Sequence[SourcedValue]) -> Markup:
    """A sentence on the assumed ones, and the table."""
    assumed = sum(parameter.assumed for parameter in parameters)
    lead = (
        f"{counted(len(parameters), 'parameter')}, {assumed} of them assumed: no citable source stands behind them. "
        "Replace those by the data of your retarder before you rely on a number of this page."
    )
    rows = [(parameter_row(parameter), "assumed" if parameter.assumed else "") for parameter in parameters]
    shown = table("Parameters", (head_row(*COLUMNS),), rows, kind="parameters")
    return joined((element("p", lead), fold("All parameters, and their sources", shown, source_list(parameters))))


def source_list(parameters: Sequence[SourcedValue]) -> Markup:
    """What the parameters cite, with author, title, year and where to find it."""
    cited = sources_cited_in(parameter.source for parameter in parameters)
    if not cited:
        return Markup()
    entries = (element("li", element("code", f"[{source.name}]"), f" {source.reference}") for source in cited)
    return joined((element("h3", "Sources"), element("ul", *entries)))


def parameter_row(parameter: SourcedValue) -> list[str | Cell]:
    """The cells of one parameter."""
    low_high = parameter.span or ABSENT
    outside = "" if parameter.in_range else "bad"
    return [
        Cell(parameter.key, kind="code"),
        Cell(value_text(parameter.value), kind=outside),
        parameter.unit,
        Cell(low_high if parameter.in_range else f"{low_high}: exceeded", kind=outside),
        parameter.source,
        parameter.confidence or ABSENT,
        Cell("assumed" if parameter.assumed else "", kind="mark"),
    ]


def value_text(value: Value) -> str:
    """A number as short as it reads back, lists with commas, pairs in brackets."""
    if isinstance(value, tuple):
        return ", ".join(f"({value_text(item)})" if isinstance(item, tuple) else value_text(item) for item in value)
    return f"{value:.9g}"
