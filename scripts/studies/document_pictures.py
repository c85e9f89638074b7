"""The pictures of the documentation, drawn from the kept results of studies.

Behind <!-- picture STUDY NAME --> a page shows a picture of that study, docs/STUDY-NAME.svg. A newer matplotlib draws
the same picture with other bytes; so the file ends with a digest of what is drawn, and that is compared.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from scripts.studies.result import Result
from synth.frame.input_error import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MARKED = re.compile(r"<!-- picture (?P<study>\S+) (?P<name>\S+) -->\n(?P<shown>!\[[^\]]+\]\((?P<file>[^)]+)\))?")


def pictures_of(path: Path) -> Iterator[tuple[str, str, Path]]:
    """(study, picture, file) of every marked picture of the page `path`. Raises `InputError` where it shows none."""
    for found in _MARKED.finditer(path.read_text(encoding="utf-8")):
        study, name = found["study"], found["name"]
        file = f"{study}-{name}.svg" if path.name != "README.md" else f"docs/{study}-{name}.svg"
        if found["file"] != file:
            raise InputError(f"{path}: the line after <!-- picture {study} {name} --> must show {file}, with a text")
        yield study, name, path.parent / file


def digest_of(figure: Figure) -> str:
    """16 hexadecimal digits of all texts, lines and boxes of `figure` with their places."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Rectangle
    from matplotlib.text import Text

    facts = []
    for each in figure.findobj():
        match each:
            case Text():
                facts.append(f"{each.get_text()} {rounded(each.get_position())}")
            case Line2D():
                facts.append(rounded(np.asarray(each.get_xydata(), dtype=np.float64).ravel()))
            case Rectangle():
                facts.append(rounded(each.get_bbox().extents))
    return hashlib.sha256("\n".join(sorted(facts)).encode()).hexdigest()[:16]


def rounded(numbers: Iterable[float]) -> str:
    """Numbers with four decimals: the last bits are the processor's."""
    return " ".join(f"{float(number) + 0.0:.4f}" for number in numbers)


def is_stale(file: Path, result: Result, name: str) -> bool:
    """Whether `file` is another picture than that of `result`."""
    return not file.is_file() or not file.read_text(encoding="utf-8").endswith(end_of(figure_of(result, name)))


def write_picture(file: Path, result: Result, name: str) -> None:
    """Draw the picture `name` of `result` into `file`."""
    from synth.frame.picture.figure_file import draw

    figure = figure_of(result, name)
    end = end_of(figure)  # of the figure as `is_stale` sees it: drawing one makes its ticks
    file.write_text(draw(figure).decode().rstrip() + end, encoding="utf-8")


def end_of(figure: Figure) -> str:
    """The last line of a file."""
    return f"\n<!-- drawn: {digest_of(figure)} -->\n"


def figure_of(result: Result, name: str) -> Figure:
    """The picture `name` of `result`; `InputError` if it has none."""
    figures = result.study.figures(result.findings)
    if name not in figures:
        raise InputError(f"the study {result.study.name} has no picture {name!r}; it has {', '.join(figures)}")
    return figures[name]
