"""The small books as the compiled kernels make them, and as their plain text does."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from synth.cli.qualification.check import Check, checked, not_checked
from synth.cli.qualification.tuned import Tuned
from synth.kernels.plain import VARIABLE


def tune_checks(books: Sequence[Tuned]) -> Iterator[Check]:
    """Whether each book was made, and keeps its limits."""
    for book in books:
        how, limit = "retarder-synth tune, as its user calls it", "exit code 0: the limits of its problem are kept"
        found = "; ".join(each["sentence"] for each in book.summary["limits"]) if book.content else book.ran.sentence
        yield checked(f"Tune, {book.kind} speed", how, found, limit, book.ran.code == 0)


def plain_checks(books: Sequence[Tuned], plain: Sequence[Tuned]) -> Iterator[Check]:
    """Whether the plain text makes the same files."""
    how, limit = f"the same tune with {VARIABLE}=1: nothing of numba that it does not document", "every file equal"
    for book, other in zip(books, plain, strict=True):
        what = f"Kernels, {book.kind} speed: against their plain text"
        if not (book.content and other.content):
            yield not_checked(what, how, f"a tune failed: plain, {other.ran.sentence}", limit)
            continue
        names = sorted(book.content.keys() | other.content.keys())
        unlike = [name for name in names if book.content.get(name) != other.content.get(name)]
        told = f"other bytes: {', '.join(unlike)}" if unlike else "all equal"
        yield checked(what, how, f"{len(names)} files; {told}", limit, not unlike)
