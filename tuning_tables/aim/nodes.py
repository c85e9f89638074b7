"""Numbers at the nodes of an aim table: arrays of float64 in which NaN stands for null."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.declared.leaf import Json
from tuning_tables.declared.numbers import Number
from tuning_tables.declared.place import Place
from tuning_tables.errors import InvalidTable

Nodes = npt.NDArray[np.float64]


@dataclass(frozen=True)
class NodeNumbers:
    """Numbers from `least` to `most` at the nodes of a table, null where there is none; an array in Python."""

    meaning: str
    least: float
    most: float = math.inf
    unit: str = ""
    axes: None = None
    dtype: str = "<f8"

    @property
    def allowed(self) -> str:
        """Its limits in words."""
        return f"{Number('', self.least, self.most).allowed}, or null"

    def check(self, value: Any, key: str) -> None:
        """Nothing yet: the table knows their shape, and looks at them with it."""

    def written(self, value: Any) -> object:
        """Arrays in arrays, null where there is no number."""
        if np.ndim(value) > 1:
            return [self.written(part) for part in value]
        return [None if np.isnan(number) else float(number) for number in value]

    def read(self, value: object, place: Place) -> Any:
        """Arrays in arrays, all of one length side by side, of numbers or null."""
        return np.array(_rectangle(value, place), dtype=np.float64)

    def schema(self) -> Json:
        """Arrays in arrays, two or three deep, of numbers or null."""
        number = {"anyOf": [{"type": "null"}, Number(self.meaning, self.least, self.most).schema()]}
        inner = {"anyOf": [*number["anyOf"], {"type": "array", "items": number, "minItems": 1}]}
        row = {"type": "array", "items": inner, "minItems": 1}
        return {"type": "array", "items": row, "minItems": 1}

    def cells(self, value: Any) -> Any:
        """Itself."""
        return value

    def of_cells(self, cells: Any) -> Any:
        """Itself."""
        return cells


def _rectangle(value: object, place: Place) -> Any:
    """`value`, numbers or null in arrays in arrays, each as long as those beside it; NaN for null."""
    if value is None:
        return np.nan
    if not isinstance(value, list):
        return ANY_NUMBER.read(value, place)
    found = [_rectangle(item, place.item(index)) for index, item in enumerate(value)]
    for index, (item, each) in enumerate(zip(value, found, strict=True)):
        if np.shape(each) != np.shape(found[0]):
            place.item(index).refuse(item, "of the shape of the entries beside it")
    return found


ANY_NUMBER: Final = Number("at a node")


def nodes_of(values: npt.ArrayLike, key: str, shape: tuple[int, ...]) -> Nodes:
    """A copy of `values` as float64, read-only; `InvalidTable` for another shape, an infinity or -0.0."""
    try:
        nodes = np.array(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InvalidTable(f"{key} makes no array of numbers; give one of the shape {shape}.") from None
    if nodes.shape != shape:
        raise InvalidTable(f"{key} has the shape {nodes.shape}, but the axes give {shape}.")
    require_all(~np.isinf(nodes), nodes, key, "finite, or null")
    require_all((nodes != 0.0) | ~np.signbit(nodes), nodes, key, "0.0, without a sign")
    nodes.setflags(write=False)
    return nodes


def require_all(holds: npt.NDArray[np.bool_], nodes: Nodes, key: str, wanted: str) -> None:
    """`holds` is true at every node; raises `InvalidTable` for the first where it is not, NaN is told as null."""
    if not holds.all():
        place = tuple(int(index) for index in np.argwhere(~holds)[0])
        value = float(nodes[place])
        told = "null" if np.isnan(value) else repr(value)
        raise InvalidTable(f"{key}{''.join(f'[{index}]' for index in place)} is {told}, but it must be {wanted}.")
