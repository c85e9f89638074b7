"""What a result shows, stated once: tables of declared columns, sentences, charts and files, in chapters.

An exhibit holds what was computed and computes nothing. Terminal, page, CSV and JSON are made from it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from synth.frame.interval import Interval
from synth.frame.printed_numbers import ABSENT, three_figures

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Row = Mapping[str, Any]
"""The figures of a row by the keys of the columns: numbers, `Interval`s, words, truth values; None and NaN are none."""

Form = Callable[[float], str]
"""How a number is printed."""


def never(value: Any) -> bool:
    """Nothing is."""
    return False


@dataclass(frozen=True)
class Column:
    """One figure of every row: `key` for programs, `heading` and `unit` for people.

    `form` prints a number, and each of the three of an `Interval`; JSON and CSV keep all digits. `once`: a cell is
    blank where it and the `once` columns before it repeat the row above. `spare`: 0 for what a reader cannot do
    without; of the others a narrow terminal leaves out the highest first. `detail`: no terminal shows it. `code`: no
    person sees it. `words`: the cells are words. `grey`: values that are printed as not decided.
    """

    key: str
    heading: str
    unit: str = ""
    form: Form = three_figures
    once: bool = False
    spare: int = 0
    detail: bool = False
    code: bool = False
    words: bool = False
    grey: Callable[[Any], bool] = never

    @property
    def title(self) -> str:
        """The heading with its unit."""
        return f"{self.heading}, {self.unit}" if self.unit else self.heading

    def has(self, row: Row) -> bool:
        """Whether `row` holds such a figure."""
        return shown_value(row.get(self.key), self.form) != ABSENT

    def text(self, row: Row) -> str:
        """What people read in `row`."""
        return shown_value(row.get(self.key), self.form)

    def brief(self, row: Row) -> str:
        """What they read where there is little room."""
        return brief_value(row.get(self.key), self.form)


def shown_value(value: Any, form: Form) -> str:
    """A value in words: whole numbers as they are, others by `form`, intervals in brackets."""
    match value:
        case None:
            return ABSENT
        case bool():
            return "yes" if value else "no"
        case str():
            return value
        case int():
            return str(value)
        case Interval():
            return f"{form(value.value)} [{form(value.low95)}, {form(value.high95)}]"
        case tuple() | list():
            return ", ".join(shown_value(each, form) for each in value) or ABSENT
    return ABSENT if math.isnan(value) else form(float(value))


def brief_value(value: Any, form: Form) -> str:
    """`shown_value`, but an interval by its wider half, where that says enough; of what was never met the bound."""
    if not isinstance(value, Interval):
        return shown_value(value, form)
    if value.value == value.low95 == 0.0 and value.high95 > 0.0:
        return f"below {form(value.high95)}"
    if not math.isfinite(value.half_width):
        ends = {form(each) for each in (value.value, value.low95, value.high95)}
        return ends.pop() if len(ends) == 1 else shown_value(value, form)
    half = form(value.half_width).lstrip("+")
    says_enough = half not in (form(0.0).lstrip("+"), form(math.inf).lstrip("+")) and value.is_told_by_half
    return f"{form(value.value)} ±{half}" if says_enough else shown_value(value, form)


@dataclass(frozen=True)
class Table:
    """`name`: of its CSV file, and in JSON. `brief`: the terminal shows it too. `bad`: rows that a page marks.

    `long`: a row for every pass or cut, so a page only says where they are. People do not see a column without any
    figure; CSV and JSON have all.
    """

    name: str
    title: str
    columns: Sequence[Column]
    rows: Sequence[Row]
    brief: bool = False
    bad: Callable[[Row], bool] = never
    long: bool = False

    @property
    def file(self) -> str:
        """The name of its CSV file."""
        return f"sheets/{self.name}.csv"

    @property
    def seen(self) -> tuple[Column, ...]:
        """The columns for people in which some row has a figure."""
        columns = (column for column in self.columns if not column.code)
        return tuple(column for column in columns if any(column.has(row) for row in self.rows) or not self.rows)


@dataclass(frozen=True)
class Sentence:
    """A sentence, or a few; `figures`: what JSON keeps of it by name. `brief`: the terminal shows it too.

    `to_do`: it says what to do first; a page has it beside the verdict.
    """

    text: str
    figures: Mapping[str, Any] = field(default_factory=dict)
    brief: bool = False
    to_do: bool = False


@dataclass(frozen=True)
class Chart:
    """`draw` makes the figure; it is called only where pictures are asked for. `name`: of its files."""

    name: str
    title: str
    caption: str
    draw: Callable[[], Figure]


@dataclass(frozen=True)
class File:
    """A file of its own beside the others: a section of a configuration, for one.

    `title`: of the link to it on the page; without one the page only lists it.
    """

    name: str
    content: bytes
    title: str = ""


@dataclass(frozen=True)
class Tile:
    """A figure that is read at a glance: `figure` in words, large, and what it is of. `kept`: its colour by a limit.

    A tile holds no figure of its own: tables have it, with all digits.
    """

    figure: str
    of: str
    kept: bool | None = None


@dataclass(frozen=True)
class Tiles:
    """A few tiles side by side; a page alone shows them, below its verdict."""

    tiles: Sequence[Tile]


Exhibit = Table | Sentence | Chart | File | Tiles


@dataclass(frozen=True)
class Chapter:
    """Exhibits under one heading."""

    heading: str
    exhibits: Sequence[Exhibit]


def exhibits_of(chapters: Sequence[Chapter]) -> Iterator[Exhibit]:
    """The exhibits of all chapters, in their order."""
    return (each for chapter in chapters for each in chapter.exhibits)
