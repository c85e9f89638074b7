"""All golden rows of a table for point sensors, and how much of them a self-test holds."""

from __future__ import annotations

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
