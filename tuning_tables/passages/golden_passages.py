"""All golden rows of a table for point sensors, and how much of them a self-test holds."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tuning_tables.passages.golden_pulses import few_golden_pairs, few_golden_pulses, golden_pairs, golden_pulses
from tuning_tables.passages.golden_stages import few_golden_stages, golden_stages
from tuning_tables.passages.passage_table import PassageTable


@dataclass(frozen=True, eq=False)
class GoldenPassages:
    """Rows of `STAGE_ROW`, `PAIR_ROW` and `PULSE_ROW` of one table (see `golden_stages`, `golden_pulses`)."""

    stages: npt.NDArray[np.void]
    pairs: npt.NDArray[np.void]
    pulses: npt.NDArray[np.void]

    def __post_init__(self) -> None:
        for array in vars(self).values():
            array.setflags(write=False)


def golden_passages(table: PassageTable) -> GoldenPassages:
    """All that may show a fault."""
    return GoldenPassages(golden_stages(table), golden_pairs(table), golden_pulses(table))


def few_golden_passages(table: PassageTable) -> GoldenPassages:
    """What a small controller holds."""
    return GoldenPassages(few_golden_stages(table), few_golden_pairs(table), few_golden_pulses(table))


def row_words(number: int, rows: npt.NDArray[np.void]) -> npt.NDArray[np.uint32]:
    """The rows of table `number` as words, its number first: uint32 (n, 1 + fields); every field is 32 bits wide."""
    words = np.ascontiguousarray(rows).view(np.uint32).reshape(len(rows), -1)
    return np.column_stack([np.full(len(rows), number, dtype=np.uint32), words])


def golden_crc(golden: Sequence[GoldenPassages]) -> int:
    """CRC-32 of the checksums of all rows of stages, of pairs, and of pulses, each word from its lowest byte up."""
    kinds = zip(*((each.stages, each.pairs, each.pulses) for each in golden), strict=True)
    sums = [
        zlib.crc32(b"".join(row_words(number, rows).astype("<u4").tobytes() for number, rows in enumerate(kind)))
        for kind in kinds
    ]
    return zlib.crc32(np.array(sums, dtype="<u4").tobytes())
