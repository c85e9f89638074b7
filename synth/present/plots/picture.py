"""A drawn picture with its title and caption, and its files; nothing here needs matplotlib."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tuning_tables.atomic_file import write_atomically


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


def save_picture(picture: Picture, directory: Path) -> tuple[Path, Path]:
    """Write the picture's PNG and SVG into `directory`; raises `OSError`."""
    return save_drawing(picture.drawing, directory, picture.name)


def save_drawing(drawing: Drawing, directory: Path, name: str) -> tuple[Path, Path]:
    """Write `directory/name.png` and `.svg`, each complete or not at all; raises `OSError`."""
    paths = directory / f"{name}.png", directory / f"{name}.svg"
    for path, content in zip(paths, (drawing.png, drawing.svg), strict=True):
        write_atomically(path, content)
    return paths
