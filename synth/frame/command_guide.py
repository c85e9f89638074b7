"""What the help of a group of commands shows besides names: sections, and an example and a page of each command."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

PROGRAM: Final = "retarder-synth"
PAGES: Final = "docs"
"""Where pages are in a checkout."""


@dataclass(frozen=True)
class Shown:
    """`example`: as it is typed behind the name of the program; `page`: of the documentation."""

    example: str
    page: str

    @property
    def epilog(self) -> str:
        """What stands at the end of the help."""
        return f"Example: {PROGRAM} {self.example}\n\nMore: {PAGES}/{self.page}"


@dataclass(frozen=True)
class CommandGuide:
    """Of the group that is typed `words` ("" for the program): its commands by `sections`, and what is `shown` of each;
    nothing of a group within it, which has a guide of its own."""

    words: str
    sections: Mapping[str, tuple[str, ...]]
    shown: Mapping[str, Shown]
