"""Types and variables of the evaluator: a value is one number, or one for each lane of a run over many inputs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt


class Fault(Exception):
    """The program does what a controller would trap, or what the evaluator has no meaning for."""


Value: TypeAlias = Any
"""A numpy number for all lanes, or an array with one for each: float32 or float64, int64, bool_."""

Mask: TypeAlias = npt.NDArray[np.bool_] | None
"""In which lanes something is executed, None for all."""

DTYPES: Mapping[str, type[np.float32 | np.int64 | np.bool_]] = {"REAL": np.float32, "INT": np.int64, "BOOL": np.bool_}
INT_LIMITS = (-32768, 32767)


@dataclass(frozen=True)
class Scalar:
    """REAL, INT or BOOL."""

    kind: str


@dataclass(frozen=True)
class Array:
    """Scalars from index `low` to `high`."""

    low: int
    high: int
    element: Scalar


@dataclass(frozen=True)
class Record:
    """A STRUCT or the variables of a function block; compared by name."""

    name: str
    members: Mapping[str, tuple[Kind, Initial]]
    is_block: bool = False

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Record) and self.name == other.name

    def __hash__(self) -> int:
        return hash(self.name)


Kind: TypeAlias = Scalar | Array | Record
Initial: TypeAlias = Value | Sequence[Value] | None


def somewhere(wrong: Value, mask: Mask) -> bool:
    """Whether `wrong` (one for all lanes, or one each) is true in a lane of `mask`."""
    if np.ndim(wrong) == 0:
        return bool(wrong)  # no mask is without any lane
    return bool((wrong if mask is None else wrong & mask).any())


def rounded(value: Value, dtype: npt.DTypeLike, mask: Mask) -> Value:
    """`value` in the type of a variable; where `mask` is true, no finite number may exceed it."""
    if getattr(value, "dtype", None) == dtype:
        return value
    narrow = np.asarray(value, dtype=dtype)[()]
    if somewhere(np.isfinite(value) & ~np.isfinite(narrow), mask):
        raise Fault("an assigned number exceeds REAL")
    return narrow


class Cell:
    """A scalar variable: `value` is of shape () or (lanes,)."""

    def __init__(self, kind: str, value: Value = 0) -> None:
        self.kind = kind
        self.value: Value = DTYPES[kind](value)

    def store(self, value: Value, mask: Mask) -> None:
        """Take over `value` where `mask` (None: everywhere) is true, rounded to REAL if it is wider."""
        value = rounded(value, DTYPES[self.kind], mask)
        self.value = value if mask is None else np.where(mask, value, self.value)


class Row:
    """An array variable: `data` is of shape (length,) or (lanes, length)."""

    def __init__(self, shape: Array, values: Sequence[Value] | None = None) -> None:
        self.shape = shape
        length = shape.high - shape.low + 1
        if values is not None and len(values) != length:
            raise Fault(f"{len(values)} values for an array of {length}")
        self.data = np.zeros(length, DTYPES[shape.element.kind]) if values is None else np.array(values)

    def place(self, index: Value, mask: Mask) -> Value:
        """`index` from 0, checked where `mask` is true, harmless elsewhere."""
        low, high = self.shape.low, self.shape.high
        outside = (index < low) | (index > high)
        if somewhere(outside, mask):
            raise Fault(f"an index leaves [{low}..{high}]")
        return index - low if np.ndim(index) == 0 else np.where(outside, 0, index - low)

    def load(self, index: Value, mask: Mask) -> Value:
        """The elements at `index`."""
        place = self.place(index, mask)
        if self.data.ndim == 1:
            return self.data[place]
        return self.data[:, place] if np.ndim(place) == 0 else self.data[np.arange(len(self.data)), place]

    def store(self, index: Value, value: Value, mask: Mask) -> None:
        """Take over `value` at `index` where `mask` is true."""
        place = self.place(index, mask)
        value = rounded(value, self.data.dtype, mask)
        lanes = max(np.size(each) if np.ndim(each) else 0 for each in (place, value, 0 if mask is None else mask))
        if lanes and self.data.ndim == 1:
            self.data = np.tile(self.data, (lanes, 1))
        if self.data.ndim == 1:
            self.data[place] = value
        else:
            rows = np.flatnonzero(np.ones(len(self.data), bool) if mask is None else mask)
            pick = [each[rows] if np.ndim(each) else each for each in (place, value)]
            self.data[rows, pick[0]] = pick[1]


Frame: TypeAlias = dict[str, Any]
"""The variables of a record or block by name; each is a `Cell`, `Row` or `Frame`, as its declaration says."""

Variable: TypeAlias = Cell | Row | Frame


def variable(kind: Kind, value: Initial = None) -> Variable:
    """A variable of the type `kind`, zero or with the initial `value`; a record's is a dictionary of variables."""
    if isinstance(kind, Scalar):
        return Cell(kind.kind, 0 if value is None else value)
    if isinstance(kind, Array):
        return Row(kind, value)
    return {name: variable(*member) for name, member in kind.members.items()}
