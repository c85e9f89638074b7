"""A table for point sensors as the block of 32-bit words that the C controller holds, protected by a CRC-32.

Words, each from its lowest byte to its highest: category number, axles, stages (K + 1), passages heard, passages at
which is decided, how many of these lie before the entrance, entrance stage, initial stage; as binary32 mass_t, target
speed in m/s, base of a sensor in m, the six limits of the tracker; of every passage heard the path in m as binary32,
then the sensor of each, then the number of the deciding passage that each is (4294967295: none); as binary32 the
switching speeds by deciding passage, stage in force and threshold; and the CRC-32 of all words before it. All tables of
an export have blocks of one size, that of its tables with most passages and stages; what a table has not is 0. An
infinite switching speed is the largest finite number with its sign: no credible reading is beyond either.
"""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from tuning_tables.category_number import LARGEST_OWN, LEAST_OWN
from tuning_tables.errors import InvalidTable
from tuning_tables.passages.passage_table import PassageTable

Floats: TypeAlias = npt.NDArray[np.float32]

COUNTS: Final = 8
"""Words before the numbers: category to initial stage."""

NUMBERS: Final = 9
"""Mass, target, base and the six limits."""

LARGEST: Final = np.finfo(np.float32).max


@dataclass(frozen=True)
class PassageBlockSize:
    """Passages heard, passages at which is decided, and stages (K + 1) that there is room for in a block."""

    heard: int
    passages: int
    stages: int

    @property
    def path(self) -> slice:
        """Where the paths are."""
        first = COUNTS + NUMBERS
        return slice(first, first + self.heard)

    @property
    def sensor(self) -> slice:
        """Where the numbers of the sensors are."""
        return slice(self.path.stop, self.path.stop + self.heard)

    @property
    def deciding(self) -> slice:
        """Where the numbers of the deciding passages are."""
        return slice(self.sensor.stop, self.sensor.stop + self.heard)

    @property
    def switching(self) -> slice:
        """Where the switching speeds are, (passages, stages, stages - 1)."""
        first = self.deciding.stop
        return slice(first, first + self.passages * self.stages * (self.stages - 1))

    @property
    def words(self) -> int:
        """Length of a block in words of 32 bits, checksum included."""
        return int(self.switching.stop) + 1


def passage_block_size(tables: Sequence[PassageTable]) -> PassageBlockSize:
    """The least size that every table fits into."""
    return PassageBlockSize(
        max(len(table.heard_path_m) for table in tables),
        max(len(table.passages) for table in tables),
        max(len(table.pressure_kpa) for table in tables),
    )


def finite_speeds(table: PassageTable) -> Floats:
    """The switching speeds, float32 (M, K + 1, K), infinite ones as the largest numbers of their sign."""
    return np.clip(table.switching_m_s, -LARGEST, LARGEST)


def passage_block(table: PassageTable, size: PassageBlockSize) -> npt.NDArray[np.uint32]:
    """The words of one table, uint32 (size.words,), checksum last; raises as `exported_number`."""
    heard, passages, stages = len(table.heard_path_m), len(table.passages), len(table.pressure_kpa)
    category = exported_number(table)
    words = np.zeros(size.words, dtype=np.uint32)
    counts = (category, len(table.cut.axle_offsets_m), stages, heard, passages, table.before_entrance)
    words[:COUNTS] = (*counts, table.entrance_stage, table.initial_stage)
    numbers = (table.cut.mass_t, table.target_speed_m_s, table.sensors.base_m)
    floats = words.view(np.float32)
    floats[COUNTS : size.path.start] = (*numbers, *table.limits)
    floats[size.path][:heard] = table.heard_path_m
    words[size.sensor][:heard] = table.heard_sensor
    words[size.deciding][:heard] = table.heard_passage.astype(np.int32).view(np.uint32)
    speeds = floats[size.switching].reshape(size.passages, size.stages, size.stages - 1)
    speeds[:passages, :stages, : stages - 1] = finite_speeds(table)
    words[-1] = zlib.crc32(words[:-1].astype("<u4").tobytes())
    words.setflags(write=False)
    return words


def exported_number(table: PassageTable) -> int:
    """What stands for the table's weight category in C and Structured Text; `InvalidTable` for one without number."""
    if table.cut.number is None:
        raise InvalidTable(
            f"{table.id} is for the category {table.cut.category}, which has no number, but controller code chooses by "
            f"number: give the table a cut.category_number in [{LEAST_OWN}, {LARGEST_OWN}] (CutId of tuning_tables), "
            "then export it."
        )
    return table.cut.number
