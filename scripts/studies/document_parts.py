"""What documents show besides the tables of studies: the keys of a configuration, and pictures, drawn from kept
results.

The keys of a configuration for its page: what a declaration says of each, in a table. Between <!-- keys NAME --> and
<!-- end --> stands that of the configuration NAME, and where its sources are.

The pictures of the documentation, drawn from the kept results of studies. Behind <!-- picture STUDY NAME --> a page
shows a picture of that study, STUDY-NAME.svg of any folder. A newer matplotlib draws the same picture with other bytes;
so the file ends with a digest of what is drawn, and that is compared.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Final

import numpy as np
from pydantic.fields import FieldInfo

from plant_models.library import load_wheel_sensor
from plant_models.library.source import CITATION
from scripts.studies.result import Result
from scripts.studies.study import table
from synth.aim.configuration.aim_file import usual_aim
from synth.aim.configuration.settings import AimFileSettings
from synth.computer.settings import ComputerSettings
from synth.frame.faults import InputError
from synth.frame.settings.numbers import Told, Usual, told_key, told_numbers, words_of
from synth.frame.settings.section import Section, sections_in
from synth.frame.settings.template import NOTHING, value_text
from synth.hump.configuration.settings import HumpTrialSettings
from synth.hump.configuration.trial_file import usual_trial
from synth.hump.making.short_file import NEEDED
from synth.hump.making.short_hump import EXAMPLE
from synth.hump.watching.settings import EXAMPLE as YARD
from synth.retarder.configuration.config_file import known_of
from synth.retarder.configuration.plant_settings import DEFAULT_WHEEL_SENSOR, PointSensorSettings
from synth.retarder.configuration.resolved_config import resolve
from synth.retarder.configuration.settings import Settings
from synth.retarder.sweep.sweep_settings import SweepTable

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DECLARED: Final[dict[str, Callable[[], tuple[Section, Usual]]]] = {
    "aim": lambda: (AimFileSettings(), usual_aim()),
    "computer": lambda: (ComputerSettings(), NOTHING),
    "hump": lambda: (HumpTrialSettings(), usual_trial()),
    "short-hump": lambda: (EXAMPLE.model_copy(update=dict.fromkeys((*NEEDED, "tracks", "position"))), NOTHING),
    "sweep": lambda: (SweepTable(), NOTHING),
    "yard": lambda: (YARD.model_copy(update={"position": None}), NOTHING),
    "tune": lambda: (Settings(), known_of(resolve(Settings(), "the default configuration"))),
    "sensors": lambda: (
        PointSensorSettings.model_construct(path_m=()),
        told_numbers(load_wheel_sensor(DEFAULT_WHEEL_SENSOR).provenance),
    ),
}
"""Configurations, or a section of one, and what the library has for keys that are left out."""

HEAD = ("key", "unless given", "unit", "allowed", "is", "from")


def keys_of(name: str, sources: str) -> str:
    """The keys of the configuration `name` as Markdown; `sources`: the page of the sources, as it is linked."""
    text = table(f"keys {name}", HEAD, rows_of(*DECLARED[name](), "")).markdown()
    links = "".join(f"[{cited}]: {sources}#{cited}\n" for cited in sorted(set(CITATION.findall(text))))
    return f"{text}\n{links}" if links else text


def rows_of(section: Section, usual: Usual, path: str) -> Iterator[tuple[str, ...]]:
    """A row for each table of the file, then one for each of its keys."""
    inner: list[tuple[str, Section | None, type[Section]]] = []
    for key, field in type(section).model_fields.items():
        value, name = getattr(section, key), f"{path}.{key}".lstrip(".")
        tables = sections_in(field)
        if tables and name not in usual:
            inner.append((name, value if isinstance(value, Section) else None, tables[0]))
        else:
            yield key_row(key, told_key(value, field, usual.get(name)), field)
    for name, held, model in inner:
        heading = f"[[{name}]]" if held is None else f"[{name}]"
        yield f"**`{heading}`**", "", "", "", " ".join((model.__doc__ or "").split()), ""
        if held is None:
            yield from (key_row(key, told_key(None, field, None), field) for key, field in model.model_fields.items())
        else:
            yield from rows_of(held, usual, name)


def key_row(key: str, told: Told, field: FieldInfo) -> tuple[str, ...]:
    """What is told of one key."""
    allowed = told.range or " or ".join(f"`{word}`" for word in words_of(field))
    value = "–" if told.value in (None, (), {}) or sections_in(field) else f"`{value_text(told.value)}`"
    return f"`{key}`", value, told.unit, allowed, field.description or "", told.source


_MARKED = re.compile(r"<!-- picture (?P<study>\S+) (?P<name>\S+) -->\n(?P<shown>!\[[^\]]+\]\((?P<file>[^)]+)\))?")


def pictures_of(path: Path) -> Iterator[tuple[str, str, Path]]:
    """(study, picture, file) of every marked picture of the page `path`. Raises `InputError` where it shows none."""
    for found in _MARKED.finditer(path.read_text(encoding="utf-8")):
        study, name = found["study"], found["name"]
        if PurePosixPath(found["file"] or "").name != f"{study}-{name}.svg":
            raise InputError(
                f"{path}: the line after <!-- picture {study} {name} --> must show {study}-{name}.svg, with a text"
            )
        yield study, name, path.parent / found["file"]


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
    from synth.frame.picture.house_style import draw

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
