"""A study: a question, how long the answer takes, its options, the run that answers it, and the tables of its answer.

Options are the fields of a frozen dataclass, and the words of a command line become one. A field has a default made by
`option`, which tells its meaning and what is allowed. Types: int, float, str, bool (a switch, off by default),
`Path | None`, and tuples of int, float or str, which take one or more words.

What can be listed is light; what runs is in a module of its own, which is imported when the study runs or is read. That
module calls its `Method` METHOD.
"""

from __future__ import annotations

import argparse
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import Field, dataclass, field, fields
from importlib import import_module
from pathlib import Path
from types import UnionType
from typing import TYPE_CHECKING, Any, Generic, NoReturn, TypeVar, get_args, get_origin, get_type_hints

from plant_models.errors import near_miss
from synth.frame.faults import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Interval = tuple[float, float]
"""Low and high end."""

ABSENT = "–"


@dataclass(frozen=True)
class MarkdownTable:
    """What a table tells (one sentence), its heads, its rows; every row has as many cells as there are heads."""

    title: str
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.heads):
                raise ValueError(f"table {self.title!r}: {len(row)} cells under {len(self.heads)} heads: {row}")

    def markdown(self) -> str:
        """The lines of the table, each with its end; the title is not in them."""
        lines = (self.heads, ("---",) * len(self.heads), *self.rows)
        return "".join(f"| {' | '.join(cells)} |\n" for cells in lines)


def table(title: str, heads: Iterable[str], rows: Iterable[Iterable[str]]) -> MarkdownTable:
    """The table of these heads and rows."""
    return MarkdownTable(title, tuple(heads), tuple(tuple(row) for row in rows))


def around(value: float, ends: Sequence[float], digits: int = 4, scale: float = 1.0) -> str:
    """'0.0419 [0.0414, 0.0425]': a figure with its interval, both times `scale`."""
    return f"{scale * value:.{digits}f} {span(ends, digits, scale)}"


def span(ends: Sequence[float], digits: int = 4, scale: float = 1.0) -> str:
    """'[0.0414, 0.0425]': an interval."""
    low, high = ends
    return f"[{scale * low:.{digits}f}, {scale * high:.{digits}f}]"


def plus_minus(value: float, ends: Sequence[float], digits: int, scale: float = 1.0) -> str:
    """'41.50 ± 0.28': a figure and half the width of its interval."""
    low, high = ends
    return f"{scale * value:.{digits}f} ± {0.5 * scale * (high - low):.{digits}f}"


_T = TypeVar("_T")
_O = TypeVar("_O")

ANY: tuple[float, float] = (-math.inf, math.inf)


def option(default: _T, meaning: str, allowed: tuple[float, float] = ANY) -> _T:
    """A field with its default, what it means, and the least and the largest number allowed."""
    return field(default=default, metadata={"meaning": meaning, "allowed": allowed})


class _Words(argparse.ArgumentParser):
    """A parser whose faults are `InputError`."""

    def error(self, message: str) -> NoReturn:
        """Raise the fault as a sentence."""
        raise InputError(f"{self.prog}: {message.removeprefix('argument ')}")


def options_from(words: Sequence[str], kind: type[_O], study: str) -> _O:
    """The options that `words` tell, the others at their defaults. Raises `InputError`."""
    parser = parser_of(kind, study)
    found, rest = parser.parse_known_args(list(words))
    if rest:
        known = [flag(each) for each in fields(kind)]  # type: ignore[arg-type]
        raise InputError(
            f"study {study}: there is no option {rest[0]}; {near_miss(rest[0], known) if known else 'it has none'}"
        )
    return kind(**vars(found))


def parser_of(kind: type[Any], study: str) -> argparse.ArgumentParser:
    """The parser of the options of one study; its help tells all of them."""
    parser = _Words(
        prog=f"study {study}", add_help=False, allow_abbrev=False, usage=f"retarder-synth study {study} [OPTIONS]"
    )
    hints = get_type_hints(kind)
    for each in fields(kind):
        meaning, name = each.metadata["meaning"], flag(each)
        if hints[each.name] is bool:
            parser.add_argument(name, action="store_true", help=meaning)
            continue
        word, many = word_type(hints[each.name])
        default: Any = each.default
        shown = " ".join(map(str, default)) if many else default
        told = meaning if shown in (None, "") else f"{meaning} ({shown})"
        parser.add_argument(
            name, type=reader(word, each.metadata["allowed"]), nargs="+" if many else None, default=default,
            action=_Tuple if many else "store", help=told.replace("%", "%%"), metavar=METAVARS[word],
        )  # fmt: skip
    return parser


class _Tuple(argparse.Action):
    """Keeps several words as a tuple."""

    def __call__(
        self, parser: Any, namespace: argparse.Namespace, values: Any, option_string: str | None = None
    ) -> None:
        """Store `values`."""
        setattr(namespace, self.dest, tuple(values))


METAVARS: dict[type[Any], str] = {int: "N", float: "X", str: "WORD", Path: "FILE"}


def flag(each: Field[Any]) -> str:
    """The word that names an option on the command line."""
    return f"--{each.name.replace('_', '-')}"


def word_type(hint: Any) -> tuple[type[Any], bool]:
    """(type of one word, whether there may be several)."""
    if get_origin(hint) is tuple:
        return get_args(hint)[0], True
    if isinstance(hint, UnionType):
        (kind,) = (each for each in get_args(hint) if each is not type(None))
        return kind, False
    return hint, False


def reader(kind: type[Any], allowed: tuple[float, float]) -> Callable[[str], Any]:
    """The function that makes a value of a word, or says what is allowed."""

    def read(word: str) -> Any:
        if kind not in (int, float):
            return kind(word)
        try:
            value = kind(word)
        except ValueError:
            value = math.nan
        if allowed[0] <= value <= allowed[1]:
            return value
        raise argparse.ArgumentTypeError(f"it is {word[:40]!r}; give a {described(kind, allowed)}")

    return read


def described(kind: type[Any], allowed: tuple[float, float]) -> str:
    """'whole number from 1000 to 10000000'."""
    noun = "whole number" if kind is int else "number"
    low, high = allowed
    match math.isfinite(low), math.isfinite(high):
        case True, True:
            return f"{noun} from {low:g} to {high:.10g}"
        case True, False:
            return f"{noun} of at least {low:g}"
    return noun


Tell = Callable[[str], None]
"""Is called with a sentence whenever a part of a study is done; any thread may call it."""


def silent(_: str) -> None:
    """Tell nobody."""


class Findings(ABC):
    """What a study has found: a frozen dataclass of plain values (numbers, text, tuples, dicts, such dataclasses).

    Its JSON form holds all of it, and it is read back from there; so tables and figures follow from values alone.
    Numbers are finite; None stands for what there is not.
    """

    @abstractmethod
    def tables(self) -> Mapping[str, MarkdownTable]:
        """The tables by name; a document shows one between <!-- study STUDY NAME --> and <!-- end -->."""

    def sentences(self) -> tuple[str, ...]:
        """What is told besides the tables."""
        return ()

    def faults(self) -> tuple[str, ...]:
        """A sentence for every claim that the study was to check and that does not hold."""
        return ()


_Options = TypeVar("_Options")
_Findings = TypeVar("_Findings", bound=Findings)


@dataclass(frozen=True)
class Method(Generic[_Options, _Findings]):
    """How a study is done.

    `options`: frozen dataclass of all options with their defaults, which are those of the documentation; `smallest`:
    options with which it runs in seconds, through every step; `findings`: the type of what `run` returns.
    """

    options: type[_Options]
    smallest: _Options
    findings: type[_Findings]
    run: Callable[[_Options, Tell], _Findings]


@dataclass(frozen=True)
class Study:
    """Name, the question that it answers (one sentence), seconds on two cores, page of docs/, module.

    `pictures`: the module whose `figures` draws the findings, '' where nothing is drawn; what draws is loaded then.
    """

    name: str
    question: str
    seconds: float
    page: str
    module: str
    pictures: str = ""

    @property
    def method(self) -> Method[Any, Findings]:
        """How it is done; imports its module."""
        found = import_module(self.module).METHOD
        assert isinstance(found, Method)
        return found

    def figures(self, findings: Findings) -> Mapping[str, Figure]:
        """Pictures by name, in the house style; a page shows each."""
        if not self.pictures:
            return {}
        drawn: Mapping[str, Figure] = import_module(self.pictures).figures(findings)
        return drawn

    @property
    def duration(self) -> str:
        """'40 s' or '12 min'."""
        return f"{self.seconds:.0f} s" if self.seconds < 100.0 else f"{self.seconds / 60.0:.0f} min"
