"""The page of a run: verdict, what to do first and tiles, then the chapters, the origin of every number, the
limits. And what a command prints that only reads, as a page: the same sentences, verdict and tables.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from importlib.metadata import version
from itertools import groupby
from typing import Final

from synth.frame.exhibits import Chapter, Chart, Exhibit, File, Sentence, Table, Tile, Tiles, exhibits_of
from synth.frame.page.document import Stamp, document, figure, file_table
from synth.frame.page.markup import Markup, element, fold, joined
from synth.frame.page.page_table import parameter_section, shown_table, table_or_words
from synth.frame.picture.picture import Picture
from synth.frame.printed_numbers import counted
from synth.frame.terminal.printed_page import Printed, PrintedTable, PrintedVerdict
from synth.frame.told import Told

VERDICTS = {True: ("Accepted", "accepted"), False: ("Not accepted", "refused"), None: ("Not decidable", "undecided")}
"""Heading of the verdict, and its style."""

WORDS = {True: "kept", False: "missed", None: "not decidable"}

MOST_LIMITS: Final = 4
"""Limits that stand in the verdict; what is more is behind a fold."""


def page_of(told: Told, pictures: Mapping[str, Picture], hashes: Mapping[str, str]) -> str:
    """One HTML document that loads nothing; `pictures` by name, `hashes`: SHA-256 of the other files by name."""
    head = told.head
    stamp = Stamp(head.title, told.created, version("retarder-synth"), head.sha256)
    return document(stamp, first_screen(told), tuple(sections(told, pictures, hashes)))


def first_screen(told: Told) -> Markup:
    """What a reader must know who reads no further: the verdict, what to do first, and the main figures."""
    exhibits = tuple(exhibits_of(told.chapters))
    to_do = [each.text for each in exhibits if isinstance(each, Sentence) and each.to_do]
    tiles = [each for of in exhibits if isinstance(of, Tiles) for each in of.tiles]
    return joined((verdict_box(told), to_do_box(to_do), tile_row(tiles)))


def verdict_box(told: Told) -> Markup:
    """Accepted, not, or not decidable, limit by limit; nothing where nothing is judged."""
    limits = told.verdict.worst_first
    if not limits:
        return Markup()
    items = [element("li", f"{WORDS[limit.kept]}: {limit.sentence}") for limit in limits]
    word, style = VERDICTS[told.verdict.kept]
    head, more = element("p", element("strong", word)), items[MOST_LIMITS:]
    rest = fold(f"{counted(len(more), 'more limit')}", element("ul", *more)) if more else ""
    first = element("ul", *items[:MOST_LIMITS])
    return element("section", head, first, rest, class_=f"verdict {style}", id="verdict")


def to_do_box(sentences: Sequence[str]) -> Markup:
    """What to do first, a step each."""
    if not sentences:
        return Markup()
    steps = (element("li", each) for each in sentences)
    return element(
        "section", element("p", element("strong", "What to do first")), element("ol", *steps), class_="to-do"
    )


def tile_row(tiles: list[Tile]) -> Markup:
    """Figures at a glance side by side."""
    return element("div", *(tile(each) for each in tiles), class_="tiles") if tiles else Markup()


def sections(
    told: Told, pictures: Mapping[str, Picture], hashes: Mapping[str, str]
) -> Iterator[tuple[str, str, Markup]]:
    """(anchor, heading, content) in the order of the page."""
    for chapter in told.chapters:
        content = chapter_content(chapter, pictures)
        if content:  # all of it may stand on the first screen
            yield anchor_of(chapter), chapter.heading, content
    if told.head.parameters:
        yield "parameters", "Parameters", parameter_section(told.head.parameters)
    if told.limits_of_use:
        yield "limits", "Limits of use", element("ul", *(element("li", each) for each in told.limits_of_use))
    yield "files", "Files", file_table(hashes)


def anchor_of(chapter: Chapter) -> str:
    """The heading as a name in links."""
    return re.sub(r"[^a-z0-9]+", "-", chapter.heading.lower()).strip("-")


def chapter_content(chapter: Chapter, pictures: Mapping[str, Picture]) -> Markup:
    """The exhibits one after another; pictures that follow one another stand side by side where there is room."""
    groups = groupby(chapter.exhibits, lambda each: isinstance(each, Chart))
    parts = ((of_charts, joined(shown(each, pictures) for each in group)) for of_charts, group in groups)
    return joined(element("div", part, class_="figures") if of_charts and part else part for of_charts, part in parts)


def shown(exhibit: Exhibit, pictures: Mapping[str, Picture]) -> Markup:
    """One exhibit; what stands on the first screen, was not drawn, or has no title leaves nothing here."""
    match exhibit:
        case Sentence() if not exhibit.to_do:
            return element("p", exhibit.text)
        case Table():
            return table_or_words(exhibit)
        case Chart() if exhibit.name in pictures:
            return figure(pictures[exhibit.name])
        case File() if exhibit.title:
            return element("p", element("a", exhibit.title, href=exhibit.name))
    return Markup()


def tile(of: Tile) -> Markup:
    """A figure at a glance."""
    style = "tile" if of.kept is None else f"tile {VERDICTS[of.kept][1]}"
    return element("div", element("strong", of.figure), element("p", of.of), class_=style)


INDENT: Final = "  "
"""A sentence that begins so is a fact of the one before it."""


def printed_document(stamp: Stamp, page: Sequence[Printed], steps: Sequence[str] = ()) -> str:
    """One HTML document of `page`: its verdicts, and `steps` to take first, above all else."""
    verdicts = (sentence_box(each) for each in page if isinstance(each, PrintedVerdict))
    shown = joined(parts([each for each in page if not isinstance(each, PrintedVerdict)]))
    return document(stamp, joined((*verdicts, to_do_box(steps))), (("found", "What was found", shown),))


def sentence_box(verdict: PrintedVerdict) -> Markup:
    """The verdict in a sentence."""
    word, style = VERDICTS[verdict.kept]
    head, sentence = element("p", element("strong", word)), element("p", verdict.sentence)
    return element("section", head, sentence, class_=f"verdict {style}", id="verdict")


def parts(page: Sequence[Printed]) -> Iterator[Markup]:
    """Sentences, facts in a list below the sentence that they belong to, and tables."""
    for is_fact, group in groupby(page, lambda each: isinstance(each, str) and each.startswith(INDENT)):
        if is_fact:
            yield element("ul", *(fact(str(each)) for each in group), class_="facts")
        else:
            yield from map(sentence_or_table, group)


def fact(text: str) -> Markup:
    """A fact; what it is about stands apart from it by two spaces or more."""
    name, _, told = text.strip().partition(INDENT)
    return element("li", element("strong", name), f" {told.strip()}") if told else element("li", name)


def sentence_or_table(each: Printed) -> Markup:
    """What is no fact of a sentence before it."""
    if isinstance(each, PrintedTable):
        return shown_table(replace(each.table, title=each.table.title or each.elsewhere), each.columns)
    return element("p", str(each))
