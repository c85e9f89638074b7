"""Constant arrays of Structured Text from numbers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.language.records import Kind
from tuning_tables.language.st_data import real
from tuning_tables.language.st_unit import ArrayOf, Variable, local

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
