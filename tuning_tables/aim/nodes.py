"""Numbers at the nodes of an aim table: arrays of float64 in which NaN stands for null; and what cuts did that
were sent off with its exit speeds, at each of them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.declared.members import Json, Place
from tuning_tables.declared.numbers import Count, Number
from tuning_tables.errors import InvalidTable, require_count

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


FIGURES: Final = ("p_overspeed", "p_overspeed_low95", "p_overspeed_high95", "mean_gap_m")
"""What is told of every node."""


@dataclass(frozen=True, eq=False)
class Reported:
    """Figures of simulated cuts at the nodes, of other draws than those that the exit speeds were chosen on.

    The share lies within its interval. All figures have the shape of the axes, and NaN at the same nodes: where there
    is no exit speed, and where too few of the passes came to a node to tell. Read-only copies. Raises `InvalidTable`.

    Examples
    --------
    >>> from tuning_tables.aim import Reported
    >>> figures = Reported(
    ...     2000,
    ...     p_overspeed=[[0.08]],
    ...     p_overspeed_low95=[[0.07]],
    ...     p_overspeed_high95=[[0.09]],
    ...     mean_gap_m=[[12.5]],
    ... )
    >>> figures.p_overspeed.shape
    (1, 1)
    """

    passes: Annotated[int, Count("simulated cuts at each node", 1)]
    p_overspeed: Annotated[Nodes, NodeNumbers("share that coupled faster than required", 0.0, 1.0)]
    p_overspeed_low95: Annotated[Nodes, NodeNumbers("lower end of its 95 % interval", 0.0, 1.0)]
    p_overspeed_high95: Annotated[Nodes, NodeNumbers("upper end of its 95 % interval", 0.0, 1.0)]
    mean_gap_m: Annotated[
        Nodes, NodeNumbers("mean of what stayed free before the standing cars; 0 for a cut that coupled", 0.0)
    ]

    def __post_init__(self) -> None:
        require_count(self.passes, "reported.passes", 1)
        shape = np.shape(self.p_overspeed)
        for name in FIGURES:
            nodes = nodes_of(getattr(self, name), f"reported.{name}", shape)
            nodes.setflags(write=False)
            object.__setattr__(self, name, nodes)
        low, p, high = self.p_overspeed_low95, self.p_overspeed, self.p_overspeed_high95
        key, null = "reported.p_overspeed", np.isnan(p)
        for nodes, name in ((low, "p_overspeed_low95"), (high, "p_overspeed_high95"), (self.mean_gap_m, "mean_gap_m")):
            require_all(np.isnan(nodes) == null, nodes, f"reported.{name}", f"null exactly where {key} is")
        require_all(null | ((low >= 0.0) & (high <= 1.0)), p, key, "a share, its interval within [0, 1]")
        require_all(null | ((low <= p) & (p <= high)), p, key, "within its interval")
        require_all(null | (self.mean_gap_m >= 0.0), self.mean_gap_m, "reported.mean_gap_m", "0 m or more")

    def require_nodes(self, speeds: Nodes) -> None:
        """They have the shape of `speeds`, and no figure where that has no number."""
        key = "reported.p_overspeed"
        nodes = nodes_of(self.p_overspeed, key, speeds.shape)
        require_all(np.isnan(nodes) | ~np.isnan(speeds), nodes, key, "null where there is no exit speed")
