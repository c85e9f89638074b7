"""What a command prints that only reads, as a page: the same sentences, verdict and tables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby
from typing import Final

from synth.frame.page.document import Stamp, document
from synth.frame.page.markup import Markup, element, joined
from synth.frame.page.page_table import shown_table
from synth.frame.page.told_page import VERDICTS, to_do_box
from synth.frame.terminal.printed_page import Printed, PrintedVerdict
from synth.frame.terminal.printed_table import PrintedTable

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
