"""Options of a study: the fields of a frozen dataclass, and how the words of a command line become one.

A field has a default made by `option`, which tells its meaning and what is allowed. Types: int, float, str, bool (a
switch, off by default), `Path | None`, and tuples of int, float or str, which take one or more words.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Sequence
from dataclasses import Field, field, fields
from pathlib import Path
from types import UnionType
from typing import Any, NoReturn, TypeVar, get_args, get_origin, get_type_hints

from plant_models.library.near_miss import near_miss
from synth.frame.input_error import InputError

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
