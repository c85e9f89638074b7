"""Numbers and constant arrays as Structured Text writes them."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Sequence
from typing import Final

import numpy as np
import numpy.typing as npt

LINE_LENGTH: Final = 100
LONGEST_ARRAY: Final = 999
"""Entries of one constant array; longer ones are split, because compilers set limits of their own."""


def pieces(length: int) -> Iterator[tuple[str, int, int]]:
    """Of an array that may be too long for one constant: what each name ends with, where it begins, its length."""
    for number, start in enumerate(range(0, length, LONGEST_ARRAY)):
        yield f"_{number}" if number else "", start, min(LONGEST_ARRAY, length - start)


def place_of(start: int) -> str:
    """The place in the whole array of the element Index of a piece."""
    return f"Index + {start}" if start else "Index"


def real(value: float | np.floating) -> str:
    """`value`, finite, as a REAL literal of ten digits, from which every compiler gets the same float32 number.

    A float32 number is known from nine digits; ten leave no doubt also where the literal is read in double precision
    first. The sign of -0.0 is not written: no comparison and no sum of the rule can tell.
    """
    number = np.float32(value)
    return "0.0" if number == 0 else f"{float(number):.9E}"


def real_constant(name: str, value: float | np.floating) -> str:
    """Declaration of the constant `name` of REAL.

    A literal in a statement is LREAL for many compilers, and so not the REAL that it is compared with. Therefore every
    number that is no small whole number or short binary fraction stands in the text as such a constant.
    """
    return f"    {name} : REAL := {real(value)};"


GREATEST_REAL: Final = real_constant("GreatestReal", np.finfo(np.float32).max)
"""Declaration of the greatest REAL: a number above 0 is finite if it is not greater."""


def is_portable(values: npt.NDArray[np.float32]) -> npt.NDArray[np.bool_]:
    """Which have a literal in every language: 0, or normal and finite numbers, and not -0.0."""
    sizes = np.abs(values)
    smallest = np.finfo(np.float32).smallest_normal
    is_zero: npt.NDArray[np.bool_] = (sizes == 0) & ~np.signbit(values)
    return is_zero | ((sizes >= smallest) & np.isfinite(values))


def boolean(value: bool | np.bool_) -> str:
    """TRUE or FALSE."""
    return "TRUE" if value else "FALSE"


def real_array(name: str, values: Iterable[float | np.floating], row: int = 0) -> str:
    """Declaration of the constant array `name` of REAL from index 0, `row` values a line; 0: as many as fit."""
    return _array(name, "REAL", [real(value) for value in values], row)


def int_array(name: str, values: Iterable[int | np.integer]) -> str:
    """Declaration of the constant array `name` of INT from index 0; values of 16 bits."""
    return _array(name, "INT", [str(int(value)) for value in values])


def bool_array(name: str, values: Iterable[bool | np.bool_]) -> str:
    """Declaration of the constant array `name` of BOOL from index 0."""
    return _array(name, "BOOL", [boolean(value) for value in values])


def constants(declarations: list[str]) -> str:
    """A block of constants, and the empty line before the statements."""
    return "\n".join(["VAR CONSTANT", *declarations, "END_VAR", "", ""])


def _array(name: str, kind: str, literals: Sequence[str], row: int = 0) -> str:
    head = f"    {name} : ARRAY[0..{len(literals) - 1}] OF {kind} := ["
    body = ", ".join(literals) + "];"
    if len(head) + len(body) <= LINE_LENGTH:
        return head + body
    row = row or len(literals)
    rows = [", ".join(literals[start : start + row]) for start in range(0, len(literals), row)]
    ends = [","] * (len(rows) - 1) + ["];"]
    return "\n".join([head, *(_wrapped(text + end) for text, end in zip(rows, ends, strict=True))])


def _wrapped(text: str) -> str:
    return textwrap.fill(text, LINE_LENGTH, initial_indent=" " * 8, subsequent_indent=" " * 8)
