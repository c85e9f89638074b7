"""How far a tune or an aim is, on stderr: a line for each case, and on a terminal a bar below them."""

from __future__ import annotations

import time
from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
from rich.progress import Progress as Bar

from synth.frame.printed_numbers import few
from synth.frame.terminal.manner import Manner


class Progress:
    """Counts finished cases out of `cases`; a context manager. Its methods may be called by any thread.

    `word`: what is being done; `noun`: what the cases are called; `manner`: how much of it is told.
    """

    def __init__(self, cases: int, word: str, noun: str, manner: Manner) -> None:
        self._manner = manner
        self._cases = cases
        self._noun = noun
        self._done = 0
        self._before = 0
        self._started = time.monotonic()
        self._console = Console(stderr=True, highlight=False, soft_wrap=True)
        columns = (TextColumn(word), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
        self._bar = Bar(
            *columns, console=self._console, transient=True, disable=manner.quiet or not self._console.is_terminal
        )
        self._task = self._bar.add_task(word, total=cases)

    def __enter__(self) -> Progress:
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()

    def begin(self, there: int) -> None:
        """So many cases are there already, from an earlier run."""
        self._done = self._before = there
        if there:
            self.note(f"{there} of {self._cases} {self._noun} are there already")

    def done(self, sentence: str) -> None:
        """`sentence` tells of a case that has ended."""
        self._done += 1
        self._bar.update(self._task, completed=self._done)
        elapsed = time.monotonic() - self._started
        own = self._done - self._before
        left = elapsed / max(own, 1) * (self._cases - self._done)
        rate = pace(elapsed, own, left, self._noun)
        self.note(f"[{self._done:{len(str(self._cases))}}/{self._cases}] {sentence}; {rate}")

    def note(self, sentence: str) -> None:
        """A line of its own."""
        if self._bar.disable:
            self._manner.note(sentence)
        else:
            self._console.print(self._manner.timed(sentence), markup=False)

    def step(self, sentence: str) -> None:
        """The same of a step that is told only where all are."""
        if self._manner.verbose:
            self.note(sentence)


def pace(elapsed_s: float, done: int, left_s: float, noun: str) -> str:
    """Rate so far and time to come."""
    if elapsed_s < 1.0:
        return f"{elapsed_s:.1f} s"
    rate = f"{elapsed_s:.0f} s, {few(60.0 * done / elapsed_s)} {noun} a minute"
    return f"{rate}, about {left_s:.0f} s left" if left_s > 0.5 else rate
