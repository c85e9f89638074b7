"""An aim table as the block of 32-bit words that the C controller holds, protected by a CRC-32.

Words, each from its lowest byte to its highest: category number; how many numbers of cars, free distances and
resistances there are (0 resistances: by category alone); as binary32 p, the coupling speed, lowest and highest exit
speed; the numbers of cars; as binary32 the free distances, the resistances, the exit speeds by cars, distance and
resistance (-1: no answer); and the CRC-32 of all words before it. All tables of a set have blocks of one size, which
has room for the longest of every axis; what a table has not is 0.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tuning_tables.aim.aim_table import AimTable
from tuning_tables.aim.aim_tables import AimTables

HEAD_WORDS = 8


@dataclass(frozen=True)
class AimBlockSize:
    """Numbers of cars, free distances and resistances that there is room for in a block; one resistance at least."""

    cars: int
    distances: int
    resistances: int

    @property
    def nodes(self) -> slice:
        """Where the exit speeds are, (cars, distances, resistances)."""
        first = HEAD_WORDS + self.cars + self.distances + self.resistances
        return slice(first, first + self.cars * self.distances * self.resistances)

    @property
    def words(self) -> int:
        """Length of a block in words of 32 bits, checksum included."""
        return int(self.nodes.stop) + 1


def aim_block_size(aims: AimTables) -> AimBlockSize:
    """The least size that every table of the set fits into."""
    shapes = [table.speed_nodes.shape for table in aims.tables]
    return AimBlockSize(*(max(shape[axis] for shape in shapes) for axis in range(3)))


def aim_block(table: AimTable, size: AimBlockSize) -> npt.NDArray[np.uint32]:
    """The words of the table's block, checksum last."""
    cars, distances, resistances = table.speed_nodes.shape
    required, (low, high) = table.required, table.bounds_m_s
    head = np.array([table.category.number, cars, distances, resistances * table.is_measured], dtype=np.uint32)
    told = np.array([required.p_overspeed, required.coupling_speed_m_s, low, high], dtype=np.float32)
    listed = np.zeros(size.cars, dtype=np.uint32)
    listed[:cars] = table.axes.cars
    nodes = np.zeros((size.cars, size.distances, size.resistances), dtype=np.float32)
    nodes[:cars, :distances, :resistances] = controller_speeds(table)
    axes = [
        np.pad(table.distance_nodes, (0, size.distances - distances)),
        np.pad(table.resistance_nodes, (0, size.resistances - resistances)),
    ]
    body = np.concatenate(
        [head, told.view(np.uint32), listed, *(axis.view(np.uint32) for axis in axes), nodes.ravel().view(np.uint32)]
    )
    return np.append(body, np.uint32(zlib.crc32(body.astype("<u4").tobytes())))


def controller_speeds(table: AimTable) -> npt.NDArray[np.float32]:
    """The exit speeds at the nodes, (C, D, R), -1 for no answer, as controllers hold them."""
    speeds = table.speed_nodes
    return np.where(np.isnan(speeds), np.float32(-1.0), speeds)
