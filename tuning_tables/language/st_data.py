"""Comments, numbers and constant arrays as Structured Text writes them."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.language.records import Kind, st_name
from tuning_tables.language.st_unit import ArrayOf, Variable, local

WIDTH = 110


def real(value: float | np.floating) -> str:
    """`value`, finite, as a REAL literal of ten digits, from which every compiler gets the same float32 number.

    A float32 number is known from nine digits; ten leave no doubt also where the literal is read in double precision
    first. The sign of -0.0 is not written: no comparison and no sum of the rules can tell.
    """
    number = np.float32(value)
    return "0.0" if number == 0 else f"{float(number):.9E}"


def of_tables(member: str) -> str:
    """The constant array of a member by the number of the table."""
    return st_name(member).partition("_")[0] + "Of"


def st_comment(text: str, pad: str = "") -> list[str]:
    """The text as a comment."""
    lines = textwrap.wrap(text.replace("*)", "* )").replace("(*", "( *"), WIDTH - 6 - len(pad))
    rows = [f"{pad}{'  ' if place else '(*'} {line}" for place, line in enumerate(lines)]
    return [*rows[:-1], f"{rows[-1]} *)"]


LONGEST_ARRAY: Final = 999
"""Entries of one constant array; longer ones are split, because compilers set limits of their own."""


def pieces(length: int) -> Iterator[tuple[str, int, int]]:
    """Of an array that may be too long for one constant: what each name ends with, where it begins, its length."""
    for number, start in enumerate(range(0, length, LONGEST_ARRAY)):
        yield f"_{number}" if number else "", start, min(LONGEST_ARRAY, length - start)


def place_of(start: int) -> str:
    """The place in the whole array of the element Index of a piece."""
    index = local("Index")
    return f"{index} + {start}" if start else index


def is_portable(values: npt.NDArray[np.float32]) -> npt.NDArray[np.bool_]:
    """Which have a literal in every language: 0, or normal and finite numbers, and not -0.0."""
    sizes = np.abs(values)
    smallest = np.finfo(np.float32).smallest_normal
    is_zero: npt.NDArray[np.bool_] = (sizes == 0) & ~np.signbit(values)
    return is_zero | ((sizes >= smallest) & np.isfinite(values))


def boolean(value: bool | np.bool_) -> str:
    """TRUE or FALSE."""
    return "TRUE" if value else "FALSE"


def real_array(name: str, values: Iterable[float | np.floating], row: int = 0) -> Variable:
    """The constant array `name` of REAL from index 0, `row` values a line; 0: as many as fit."""
    return _array(name, Kind.REAL, [real(value) for value in values], row)


def int_array(name: str, values: Iterable[int | np.integer]) -> Variable:
    """The constant array `name` of INT from index 0; values of 16 bits."""
    return _array(name, Kind.INT, [str(int(value)) for value in values])


def bool_array(name: str, values: Iterable[bool | np.bool_]) -> Variable:
    """The constant array `name` of BOOL from index 0."""
    return _array(name, Kind.BOOL, [boolean(value) for value in values])


def _array(name: str, kind: Kind, literals: list[str], row: int = 0) -> Variable:
    return Variable(name, ArrayOf(kind, len(literals)), values=tuple(literals), row=row)
