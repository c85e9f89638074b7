"""How a command tells what it does: the results for people or for programs, and how much beside them."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from synth.frame.faults import InputError
from synth.frame.terminal.printed_page import Printed, PrintedVerdict, print_page
from synth.frame.terminal.telling import say


class Loudness(Enum):
    """What is told beside the results."""

    QUIET = "nothing but errors, and of results the verdict"
    USUAL = "warnings, and how far it is"
    VERBOSE = "also each step with its time"


@dataclass(frozen=True)
class Manner:
    """That of one call. `as_json`: results for programs on stdout. `began_s`: when it began, by the monotonic clock."""

    as_json: bool = False
    loudness: Loudness = Loudness.USUAL
    began_s: float = field(default_factory=time.monotonic)

    @property
    def quiet(self) -> bool:
        """Whether only errors and the verdict are told."""
        return self.loudness is Loudness.QUIET

    @property
    def verbose(self) -> bool:
        """Whether each step is told."""
        return self.loudness is Loudness.VERBOSE

    def timed(self, sentence: str) -> str:
        """`sentence`, behind the seconds since the beginning where each step is told."""
        return f"[{time.monotonic() - self.began_s:7.2f} s] {sentence}" if self.verbose else sentence

    def note(self, sentence: str) -> None:
        """A line on stderr that tells how far it is, unless errors alone are told."""
        if not self.quiet:
            print(self.timed(sentence), file=sys.stderr, flush=True)

    def step(self, sentence: str) -> None:
        """Tell, on stderr, of a step that has ended, if steps are told."""
        if self.verbose:
            self.note(sentence)

    def warn(self, sentence: str) -> None:
        """Tell of what a user should know, on stderr, unless errors alone are told."""
        if not self.quiet:
            say(sentence)

    def give(self, document: Callable[[], Any], page: Callable[[], Iterable[Printed]]) -> None:
        """Print the results to stdout: the `document` for programs, or the `page`; of it at times the verdict alone."""
        if self.as_json:
            print(json.dumps(document(), indent=1, ensure_ascii=False))
        else:
            print_page(*(each for each in page() if not self.quiet or isinstance(each, PrintedVerdict)))


def manner_of(as_json: bool, quiet: bool, verbose: bool) -> Manner:
    """As it was typed; `InputError` for two that contradict each other."""
    if quiet and verbose:
        raise InputError("-q tells less and -v more; give one of the two")
    return Manner(as_json, Loudness.QUIET if quiet else Loudness.VERBOSE if verbose else Loudness.USUAL)
