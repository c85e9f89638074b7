"""A drawn picture with its title and caption, and its file; nothing here needs matplotlib."""

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
