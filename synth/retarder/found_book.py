"""What a tune has come to: the book, what its passes say of the limits, and the files that hold its tables."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from synth.frame.exhibits import File
from synth.retarder.acceptance import CaseVerdict
from synth.retarder.case_result import CaseResult
from synth.retarder.tune import Book


@dataclass(frozen=True)
class FoundBook:
    """`verdicts`: on the cases of `book`, in its order; `files`: the tables together, in every form."""

    book: Book
    verdicts: tuple[CaseVerdict, ...]
    files: tuple[File, ...]

    @property
    def judged(self) -> Iterator[tuple[CaseResult, CaseVerdict]]:
        """Each case with its verdict."""
        return zip(self.book.cases, self.verdicts, strict=True)

    @property
    def feasible(self) -> tuple[CaseResult, ...]:
        """The cases whose position does not forbid the limit of the rms."""
        return tuple(case for case, verdict in self.judged if verdict.feasible)
