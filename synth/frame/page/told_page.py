"""The page of a run: the verdict first, then the chapters, the origin of every number, and the limits."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from importlib.metadata import version

from synth.frame.exhibits import Chapter, Chart, Column, Exhibit, File, Row, Sentence, Table, Tile, Tiles
from synth.frame.page.document import Stamp, document, figure, file_table
from synth.frame.page.markup import Cell, Markup, element, head_row, joined, table
from synth.frame.page.parameter_table import parameter_section
from synth.frame.picture.picture import Picture
from synth.frame.told import Told

VERDICTS = {True: ("Accepted", "accepted"), False: ("Not accepted", "refused"), None: ("Not decidable", "undecided")}
"""Heading of the verdict, and its style."""

WORDS = {True: "kept", False: "missed", None: "not decidable"}


def page_of(told: Told, pictures: Mapping[str, Picture], hashes: Mapping[str, str]) -> str:
    """One HTML document that loads nothing; `pictures` by name, `hashes`: SHA-256 of the other files by name."""
    head = told.head
    stamp = Stamp(head.title, told.created, version("retarder-synth"), head.sha256)
    return document(stamp, verdict_box(told), tuple(sections(told, pictures, hashes)))


def verdict_box(told: Told) -> Markup:
    """Accepted, not, or not decidable, limit by limit; nothing where nothing is judged."""
    if not told.verdict.limits:
        return Markup()
    items = (element("li", f"{WORDS[limit.kept]}: {limit.sentence}") for limit in told.verdict.limits)
    word, style = VERDICTS[told.verdict.kept]
    head = element("p", element("strong", word))
    return element("section", head, element("ul", *items), class_=f"verdict {style}", id="verdict")


def sections(
    told: Told, pictures: Mapping[str, Picture], hashes: Mapping[str, str]
) -> Iterator[tuple[str, str, Markup]]:
    """(anchor, heading, content) in the order of the page."""
    for chapter in told.chapters:
        yield anchor_of(chapter), chapter.heading, joined(shown(each, pictures) for each in chapter.exhibits)
    yield "parameters", "Parameters", parameter_section(told.head.parameters)
    if told.limits_of_use:
        yield "limits", "Limits of use", element("ul", *(element("li", each) for each in told.limits_of_use))
    yield "files", "Files", file_table(hashes)


def anchor_of(chapter: Chapter) -> str:
    """The heading as a name in links."""
    return re.sub(r"[^a-z0-9]+", "-", chapter.heading.lower()).strip("-")


def shown(exhibit: Exhibit, pictures: Mapping[str, Picture]) -> Markup:
    """One exhibit; a chart that was not drawn and a file without a title leave nothing here."""
    match exhibit:
        case Sentence():
            return element("p", exhibit.text)
        case Tiles():
            return element("div", *(tile(each) for each in exhibit.tiles), class_="tiles")
        case Table():
            return joined((element("h3", exhibit.title), table_or_words(exhibit)))
        case Chart() if exhibit.name in pictures:
            return figure(pictures[exhibit.name])
        case File() if exhibit.title:
            return element("p", element("a", exhibit.title, href=exhibit.name))
    return Markup()


def tile(of: Tile) -> Markup:
    """A figure at a glance."""
    style = "tile" if of.kept is None else f"tile {VERDICTS[of.kept][1]}"
    return element("div", element("strong", of.figure), element("p", of.of), class_=style)


def table_or_words(of: Table) -> Markup:
    """The table, or a sentence about one that is empty or too long for a page."""
    if not of.rows:
        return element("p", "None.")
    return element("p", f"{len(of.rows)} rows in {of.file}.") if of.long else shown_table(of)


def shown_table(of: Table) -> Markup:
    """The table with all columns that hold figures."""
    rows = (([cell(column, row) for column in of.seen], "bad" if of.bad(row) else "") for row in of.rows)
    return table(of.title, (head_row(*(column.title for column in of.seen)),), rows, kind="cases")


def cell(column: Column, row: Row) -> Cell:
    """One figure, or words."""
    kind = "words" if column.words else "meta" if column.grey(row.get(column.key)) else ""
    return Cell(column.text(row), kind=kind)
