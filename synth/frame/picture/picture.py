"""A drawn picture with its title and caption, and its files; nothing here needs matplotlib."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Drawing:
    """A drawn figure as the content of a PNG and of an SVG file."""

    png: bytes
    svg: bytes


@dataclass(frozen=True)
class Picture:
    """A drawing called `name` (of its files), under `section` of a report, with a title and a caption."""

    name: str
    section: str
    title: str
    caption: str
    drawing: Drawing


def picture_files(pictures: Iterable[Picture], folder: str = "") -> dict[str, bytes]:
    """The files of `pictures` by name, in `folder`."""
    return {
        name: content for each in pictures for name, content in drawing_files(each.drawing, each.name, folder).items()
    }


def drawing_files(drawing: Drawing, name: str, folder: str = "") -> dict[str, bytes]:
    """`folder/name.png` and `.svg`."""
    stem = f"{folder}/{name}" if folder else name
    return {f"{stem}.png": drawing.png, f"{stem}.svg": drawing.svg}
