"""Numbers at the nodes of an aim table: arrays of float64 in which NaN stands for null."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tuning_tables.errors import InvalidTable

Nodes = npt.NDArray[np.float64]


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
