"""A table as the block of 32-bit words that the C controller holds, protected by a CRC-32.

Words, each from its lowest byte to its highest: category number, axles, stages, powers (degree + 1); for each stage its
lines (1 lower, 2 upper, 3 both); as binary32 mass_t, target speed in m/s, s_min and s_max in m; the coefficients by
stage, line (lower, upper) and power; if any table of the book has an estimator, its number of breaks (0: none), and as
binary32 the numbers of `held_numbers` in their order, and of all breaks first s, then D, then W; if any table of the
book has an approach, its length in m as binary32 (0: none) and the entrance stage; if any table of the book decides at
any time, 1 for at any time or 0 for at rest; if any table of the book has a gauge, as binary32 the pressure of the
highest stage raised to and those of all stages in kPa, and the slopes by stage and line in m/s per kPa; and the CRC-32
of all words before it. All tables of a book have blocks of one size, that of its table with most stages, powers and
breaks; what a table has not is 0, save the entrance stage, which is then its highest.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.active_table import ActiveTable, active
from tuning_tables.decisions import Decisions
from tuning_tables.estimator import Estimator
from tuning_tables.held_numbers import HELD_NUMBERS, held_numbers
from tuning_tables.table_book import TableBook

LAYOUT: Final = 2
"""Of controller code. In layout 1 the numbers of the categories followed the order of the tables."""

HAS_LOWER, HAS_UPPER = 1, 2

ESTIMATOR_HEAD = 1 + len(HELD_NUMBERS)
"""Words of an estimator before its breaks: their number, and its own."""

APPROACH_WORDS = 2
"""Its length and the entrance stage."""


@dataclass(frozen=True)
class BlockSize:
    """Stages, coefficients of a line, and breaks of an estimator that there is room for in a block.

    Also whether there is room for an approach, for the times of decision, and for pressures and slopes.
    """

    stages: int
    powers: int
    breaks: int
    approach: bool
    any_time: bool
    gauge: bool

    @property
    def words(self) -> int:
        """Length of a block in words of 32 bits, checksum included."""
        return int(self.pressures.stop) + 1

    @property
    def coefficients(self) -> slice:
        """Where the coefficients are, (stages, 2, powers)."""
        first = 8 + self.stages
        return slice(first, first + 2 * self.stages * self.powers)

    @property
    def estimator(self) -> slice:
        """Where the estimator is: nowhere if the book has none."""
        first = self.coefficients.stop
        return slice(first, first + (ESTIMATOR_HEAD + 3 * self.breaks if self.breaks else 0))

    @property
    def approach_words(self) -> slice:
        """Where the approach is: nowhere if the book has none."""
        first = self.estimator.stop
        return slice(first, first + (APPROACH_WORDS if self.approach else 0))

    @property
    def at_any_time(self) -> slice:
        """Where it stands whether the table decides at any time: nowhere if all of the book decide at rest."""
        first = self.approach_words.stop
        return slice(first, first + self.any_time)

    @property
    def pressures(self) -> slice:
        """Where the highest pressure, those of the stages and the slopes are: nowhere if the book needs no gauge."""
        first = self.at_any_time.stop
        return slice(first, first + (1 + 3 * self.stages if self.gauge else 0))


@dataclass(frozen=True, eq=False)
class TableBlock:
    """One table as the controller holds it: its numbers, and the words of the block (uint32, checksum last)."""

    category: int
    axles: int
    mass_t: np.float32
    table: ActiveTable
    words: npt.NDArray[np.uint32]

    def __post_init__(self) -> None:
        self.words.setflags(write=False)

    @property
    def crc32(self) -> int:
        """The checksum, last of the words."""
        return int(self.words[-1])


def block_size(book: TableBook) -> BlockSize:
    """The least size that every table of the book fits into."""
    breaks = max(0 if table.estimator is None else len(table.estimator.s_m) for table in book.tables)
    approach = any(table.approach is not None for table in book.tables)
    any_time = any(table.decisions is Decisions.AT_ANY_TIME for table in book.tables)
    gauge = any(table.has_gauge for table in book.tables)
    return BlockSize(book.most_stages, book.highest_degree + 1, breaks, approach, any_time, gauge)


def block_of(
    book: TableBook, number: int, table: ActiveTable | None = None, size: BlockSize | None = None
) -> TableBlock:
    """The block of table `number` of the book, or of lines `table` made from it and its faster neighbour.

    `size`: that of the book, where the caller knows it; else it is found anew. Raises as `book.number_of`.
    """
    source = book.tables[number]
    table = table or active(source)
    category = book.number_of(source.cut.category)
    axles, mass_t = len(source.cut.axle_offsets_m), np.float32(source.cut.mass_t)
    size = size or block_size(book)
    stages, _, powers = table.coefficients.shape
    lines = np.zeros(size.stages, dtype=np.uint32)
    lines[:stages] = HAS_LOWER * table.has_line[:, 0] + HAS_UPPER * table.has_line[:, 1]
    coefficients = np.zeros((size.stages, 2, size.powers), dtype=np.float32)
    coefficients[:stages, :, :powers] = np.where(table.has_line[:, :, None], table.coefficients, np.float32(0.0))
    numbers = np.array([mass_t, table.target_speed_m_s, *table.valid_range[:2]], dtype=np.float32)
    body = np.concatenate(
        [
            np.array([category, axles, stages, powers], dtype=np.uint32),
            lines,
            numbers.view(np.uint32),
            coefficients.ravel().view(np.uint32),
            estimator_words(table.estimator, size),
            approach_words(table)[: APPROACH_WORDS * size.approach],
            np.array([table.decisions is Decisions.AT_ANY_TIME], dtype=np.uint32)[: size.any_time],
            pressure_words(table, source.has_gauge, size),
        ]
    )
    words = np.append(body, np.uint32(zlib.crc32(body.astype("<u4").tobytes())))
    return TableBlock(category, axles, mass_t, table, words)


def estimator_words(estimator: Estimator | None, size: BlockSize) -> npt.NDArray[np.uint32]:
    """The words of an estimator in a block, zeros for none."""
    words = np.zeros(size.estimator.stop - size.estimator.start, dtype=np.uint32)
    if estimator is not None:
        breaks = len(estimator.s_m)
        words[0], words[1:ESTIMATOR_HEAD] = breaks, held_numbers(estimator).view(np.uint32)
        words[ESTIMATOR_HEAD:].reshape(3, size.breaks)[:, :breaks] = estimator.work.view(np.uint32)
    return words


def approach_words(table: ActiveTable) -> npt.NDArray[np.uint32]:
    """The words of an approach in a block."""
    length_m = np.array([approach_m(table)], dtype=np.float32)
    return np.append(length_m.view(np.uint32), np.uint32(table.entrance_stage))


def pressure_words(table: ActiveTable, has_gauge: bool, size: BlockSize) -> npt.NDArray[np.uint32]:
    """The words of pressures and slopes in a block, zeros for a table without gauge."""
    words = np.zeros(size.pressures.stop - size.pressures.start, dtype=np.uint32)
    if has_gauge:
        stages, numbers = len(table.pressures), words.view(np.float32)
        numbers[0] = table.pressures[table.highest_raised]
        numbers[1 : 1 + stages] = table.pressures
        numbers[1 + size.stages :].reshape(size.stages, 2)[:stages] = table.slopes
    return words


def approach_m(table: ActiveTable) -> np.float32:
    """The length of the approach, 0 for none."""
    return np.float32(0.0 if table.approach is None else table.approach.length_m)
