"""Who is told how far work on the cases of a configuration is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

Tell = Callable[[str], None]
"""Is told a sentence when a step has ended."""


def silent(_sentence: str) -> None:
    """Nobody wants to know."""


class Watcher(Protocol):
    """Is told sentences, by any thread."""

    def done(self, sentence: str) -> None:
        """A case has ended, with a table or without: once for each."""
        ...

    def note(self, sentence: str) -> None:
        """Something beside the cases, or more of one that has ended."""
        ...


@dataclass(frozen=True)
class Teller:
    """A watcher that counts nothing and passes every sentence on."""

    tell: Tell

    def done(self, sentence: str) -> None:
        """See `Watcher`."""
        self.tell(sentence)

    def note(self, sentence: str) -> None:
        """See `Watcher`."""
        self.tell(sentence)
