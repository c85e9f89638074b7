"""A drawn picture with its title, caption and file, and the colour of a weight category: one in every picture and
on every page. Nothing here needs matplotlib.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

DARKENED: Final = "invert(.92) hue-rotate(180deg)"
"""What makes a drawing on white one on dark ground: blue stays blue, black becomes nearly white."""


@dataclass(frozen=True)
class Picture:
    """A drawing called `name` (of its file), under `section` of a report, with a title and a caption.

    `svg`: the content of its file.
    """

    name: str
    section: str
    title: str
    caption: str
    svg: bytes


def picture_files(pictures: Iterable[Picture], folder: str) -> dict[str, bytes]:
    """The files of `pictures` by name, in `folder`."""
    return {f"{folder}/{each.name}.svg": each.svg for each in pictures}


YARD: Final = ("#440154", "#3e4a89", "#25848e", "#38b977", "#bddf26")
"""Of the five categories of the yard, whose numbers are 1 to 5: from dark to pale, so that their order is one in grey,
too."""

OWN: Final = ("#d55e00", "#cc79a7", "#e69f00", "#56b4e9", "#7a4b00", "#767676")
"""Of a user's own, by their numbers; they come again where there are more."""


def category_colour(number: int) -> str:
    """The colour of the category with this `number`, which stands for it in tables and controllers for good."""
    return YARD[number - 1] if 1 <= number <= len(YARD) else OWN[number % len(OWN)]
