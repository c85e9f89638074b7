"""The columns of a file of measured passes, and what a file holds before it is cut into passes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

LARGEST_FILE_BYTES: Final = 2**30
LONGEST_TEXT: Final = 63
TEXTS: Final = ("cut_id", "category")
OPTIONAL: Final = MappingProxyType({"pressure_kpa": np.nan, "target_m_s": np.nan, "stopped_by_hand": 0.0})
"""Columns that a file may lack, and what stands for them then."""

COLUMNS: Final = (
    "cut_id", "time_s", "path_m", "speed_m_s", "pressure_kpa", "stage",
    "mass_t", "axles", "category", "target_m_s", "stopped_by_hand",
)  # fmt: skip
NUMBERS: Final = tuple(name for name in COLUMNS if name not in TEXTS)
FASTEST_M_S: Final = 40.0
MOST_STAGES: Final = 31
WHOLE: Final = ("stage", "axles", "stopped_by_hand")
RANGES: Final[Mapping[str, tuple[float, float, str]]] = MappingProxyType(
    {
        "speed_m_s": (0.0, FASTEST_M_S, " m/s"),
        "stage": (0.0, MOST_STAGES, ""),
        "pressure_kpa": (-100.0, 5000.0, " kPa"),
        "mass_t": (1.0, 20_000.0, " t"),
        "axles": (1.0, 1000.0, " axles"),
        "target_m_s": (0.0, FASTEST_M_S, " m/s"),
        "stopped_by_hand": (0.0, 1.0, ""),
    }
)
"""Lowest and highest value of a number, and its unit in a sentence. No position has more than 31 stages above 0."""
CONSTANT: Final = ("mass_t", "axles", "target_m_s", "stopped_by_hand")
"""Numbers that are one and the same in all rows of a pass."""


@dataclass(frozen=True)
class TextRuns:
    """A column of text, run by run: `value[i]` stands in the rows from `first_row[i]` on."""

    first_row: tuple[int, ...]
    value: tuple[str, ...]


@dataclass(frozen=True)
class BrokenRow:
    """The row that a file ends in the middle of: `row` as in a spreadsheet, `column` of ours that it ends in.

    `cut_id` as far as it was written; `has_whole_id`: all of it was.
    """

    row: int
    column: str
    cut_id: str
    has_whole_id: bool

    def may_be_of(self, cut_id: str) -> bool:
        """Whether the row can belong to the cut."""
        return self.cut_id == cut_id if self.has_whole_id else cut_id.startswith(self.cut_id)


@dataclass(frozen=True, eq=False)
class LogColumns:
    """The rows of one file, in SI: `numbers` (n,) by column, read-only, and the runs of the two columns of text.

    `first_number`: what a spreadsheet calls the first row. `path_is_independent`: as in `PassLog`.
    `broken_row` follows the last row; it is None where the file is whole.
    """

    source: str
    first_number: int
    numbers: Mapping[str, Floats]
    cut_id: TextRuns
    category: TextRuns
    path_is_independent: bool
    broken_row: BrokenRow | None = None

    def __post_init__(self) -> None:
        for values in self.numbers.values():
            values.setflags(write=False)

    @property
    def rows(self) -> int:
        """Number of rows n."""
        return len(self.numbers["time_s"])


@dataclass(frozen=True)
class PassFault:
    """Why a pass was left out: `row` as in a spreadsheet (HDF5: counted from 1), `column`, and one whole sentence."""

    file: str
    row: int
    column: str
    cut_id: str
    sentence: str


@dataclass(frozen=True)
class FileFault:
    """Why a file was not used, in one sentence that names it."""

    file: str
    sentence: str
