"""A number of a table, a whole number, or a row of numbers: its meaning and limits, and how each file holds it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from tuning_tables.declared.members import Json, Place
from tuning_tables.errors import (
    InvalidTable,
    require_between,
    require_count,
    require_finite,
    require_float32,
    require_positive,
    require_tuple,
)

LARGEST_WHOLE: Final = 2**53
"""That every reader of JSON keeps."""
ANY: Final = "any number"
"""What a number without limits may be."""


@dataclass(frozen=True)
class Number:
    """A finite number from `least` to `most`.

    `is_positive`: greater than 0, and any limit beside `most` is left out. `is_single`: a float32 number, so that no
    reader rounds it once more.
    """

    meaning: str
    least: float = -math.inf
    most: float = math.inf
    is_positive: bool = False
    is_single: bool = False
    unit: str = ""
    axes: tuple[str, ...] = ()

    @property
    def dtype(self) -> str:
        """As wide as it is."""
        return "<f4" if self.is_single else "<f8"

    @property
    def allowed(self) -> str:
        """Its limits in words."""
        if self.is_positive:
            return "above 0"
        if self.most < math.inf:
            return f"{self.least:g} to {self.most:g}"
        kind = "a float32 number" if self.is_single else ANY
        return f"{self.least:g} or more" if self.least > -math.inf else kind

    def check(self, value: Any, key: str) -> None:
        """It lies within the limits."""
        if self.is_positive:
            require_positive(value, key)
        elif self.least > -math.inf or self.most < math.inf:
            require_between(value, key, self.least, self.most)
        else:
            require_finite(value, key)
        if self.is_single:
            require_float32(value, key)

    def written(self, value: Any) -> object:
        """With a decimal point or an exponent."""
        return float(value)

    def read(self, value: object, place: Place) -> Any:
        """A number; -0.0 is none."""
        # JSON's true is no number, though Python's is.
        if not isinstance(value, int | float) or isinstance(value, bool):
            place.refuse(value, "a number")
        number = float(value)
        if number == 0.0 and math.copysign(1.0, number) < 0.0:
            # The canonical form, and so the checksum, does not tell it from 0.0.
            place.refuse(value, "0.0, without a sign")
        return number

    def schema(self) -> Json:
        """A number within the limits."""
        if self.is_positive:
            return {"type": "number", "exclusiveMinimum": 0}
        limits = {"minimum": self.least, "maximum": self.most}
        return {"type": "number", **{key: limit for key, limit in limits.items() if math.isfinite(limit)}}

    def cells(self, value: Any) -> Any:
        """Itself."""
        return float(value)

    def of_cells(self, cells: Any) -> Any:
        """Itself."""
        return float(cells)


@dataclass(frozen=True)
class Count:
    """A whole number from `least` to `most`; one that may be None is 1 or more, for a book holds 0 there."""

    meaning: str
    least: int = 0
    most: int = LARGEST_WHOLE
    unit: str = "1"
    axes: tuple[str, ...] = ()
    dtype: str = "<i8"

    @property
    def allowed(self) -> str:
        """Its limits in words."""
        return f"{self.least} to {self.most}" if self.most < LARGEST_WHOLE else f"{self.least} or more"

    def check(self, value: Any, key: str) -> None:
        """It is whole, and within the limits."""
        require_count(value, key, self.least, self.most)

    def written(self, value: Any) -> object:
        """Without a decimal point."""
        return int(value)

    def read(self, value: object, place: Place) -> Any:
        """An integer, written without a decimal point."""
        if not isinstance(value, int) or isinstance(value, bool):
            place.refuse(value, "a whole number")
        return value

    def schema(self) -> Json:
        """An integer within the limits."""
        most = {"maximum": self.most} if self.most < LARGEST_WHOLE else {}
        return {"type": "integer", "minimum": self.least, **most}

    def cells(self, value: Any) -> Any:
        """Itself."""
        return int(value)

    def of_cells(self, cells: Any) -> Any:
        """Itself."""
        return int(cells)


@dataclass(frozen=True)
class Row:
    """From `fewest` to `most` numbers, or rows of them, along `axis`; a tuple in Python."""

    of: Number | Count | Row
    axis: str
    fewest: int = 1
    most: int | None = None

    @property
    def meaning(self) -> str:
        """That of its numbers."""
        return self.of.meaning

    @property
    def unit(self) -> str:
        """That of its numbers."""
        return self.of.unit

    @property
    def allowed(self) -> str:
        """That of its numbers, and how many."""
        most = " or more" if self.most is None else "" if self.fewest == self.most else f" to {self.most}"
        if isinstance(self.of, Row):
            return f"{self.fewest}{most} rows of {self.of.allowed}"
        each = "" if self.of.allowed == ANY else f", each {self.of.allowed}"
        return f"{self.fewest}{most} numbers{each}"

    @property
    def axes(self) -> tuple[str, ...]:
        """Its own first."""
        return self.axis, *self.of.axes

    @property
    def dtype(self) -> str:
        """That of its numbers."""
        return self.of.dtype

    def check(self, value: Any, key: str) -> None:
        """It is a tuple of so many numbers, each within the limits."""
        require_tuple(value, key, self.fewest if self.fewest == self.most else None)
        if len(value) < self.fewest or (self.most is not None and len(value) > self.most):
            most = "" if self.most is None else f" to {self.most}"
            raise InvalidTable(f"{key} has {len(value)} entries, but {self.fewest}{most or ' or more'} are allowed.")
        for index, item in enumerate(value):
            self.of.check(item, f"{key}[{index}]")

    def written(self, value: Any) -> object:
        """An array."""
        return [self.of.written(item) for item in value]

    def read(self, value: object, place: Place) -> Any:
        """An array."""
        items = place.array(value)
        if self.fewest == self.most and len(items) != self.fewest:
            place.refuse(value, f"an array of {NUMERALS[self.fewest]} numbers")
        return tuple(self.of.read(item, place.item(index)) for index, item in enumerate(items))

    def schema(self) -> Json:
        """An array of so many."""
        most = {} if self.most is None else {"maxItems": self.most}
        return {"type": "array", "items": self.of.schema(), "minItems": self.fewest, **most}

    def cells(self, value: Any) -> Any:
        """In rows."""
        return [self.of.cells(item) for item in value]

    def of_cells(self, cells: Any) -> Any:
        """Those that are no filling."""
        return present_rows(cells)


NUMERALS: Final = {2: "two", 3: "three"}


def present_rows(cells: Any) -> Any:
    """The numbers in an array of float that are not NaN, in tuples of tuples; empty rows are left out."""
    if np.ndim(cells) == 1:
        return tuple(float(cell) for cell in cells if not math.isnan(cell))
    rows: Sequence[Any] = [present_rows(row) for row in cells]
    return tuple(row for row in rows if row)
