"""Every picture of a book, drawn in this process."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from synth.book.case_names import by_class
from synth.book.case_result import CaseResult
from synth.frame.picture.picture import Picture
from synth.present.plots.picture_book import book_pictures, case_pictures, class_pictures


def all_pictures(cases: Sequence[CaseResult], limit_m_s: float) -> Iterator[Picture]:
    """In the order of the report; each is drawn when it is asked for."""
    yield from book_pictures(cases, limit_m_s)
    for group in by_class(cases):
        yield from class_pictures(group)
    for case in cases:
        yield from case_pictures(case)
