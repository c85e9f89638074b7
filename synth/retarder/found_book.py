"""What a tune has come to: the book, what its passes say of the limits, and the files that hold its tables."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Generic

from synth.frame.exhibits import File
from synth.retarder.acceptance import CaseVerdict
from synth.retarder.tune import Book
from synth.retarder.tuned_case import Case


@dataclass(frozen=True)
class FoundBook(Generic[Case]):
    """`verdicts`: on the cases of `book`, in its order; `files`: the tables together, in every form.

    `no_st`: why there is no Structured Text among them, '' where there is, or where none is written.
    """

    book: Book[Case]
    verdicts: tuple[CaseVerdict, ...]
    files: tuple[File, ...]
    no_st: str = ""

    @property
    def judged(self) -> Iterator[tuple[Case, CaseVerdict]]:
        """Each case with its verdict."""
        return zip(self.book.cases, self.verdicts, strict=True)

    @property
    def feasible(self) -> tuple[Case, ...]:
        """The cases whose position does not forbid the limit of the rms."""
        return tuple(case for case, verdict in self.judged if verdict.feasible)
