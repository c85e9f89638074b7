"""The words that a C controller holds of a table, and where among them its members are."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from tuning_tables.active_table import ActiveTable
from tuning_tables.controller_code.code import crc32_of, words_of
from tuning_tables.controller_code.line_code import held_values, room_of
from tuning_tables.language.records import SizedRecord
from tuning_tables.programs.line_table import LINE_TABLE
from tuning_tables.table_book import TableBook


def held_record(book: TableBook) -> SizedRecord:
    """The table of the book's export."""
    return LINE_TABLE.sized(room_of(book.tables))


def table_words(book: TableBook) -> int:
    """How many words of 32 bits each table of the book has, checksum included."""
    return held_record(book).words() + 1


def held_words(book: TableBook, number: int, lines: ActiveTable | None = None) -> NDArray[np.uint32]:
    """The words of table `number`, or of `lines` made from it, uint32 (words,): the last is the checksum."""
    record = held_record(book)
    return sealed(words_of(record, held_values(book, number, record, lines)))


def sealed(words: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """The words without a checksum, and theirs behind them."""
    return np.append(words, np.uint32(crc32_of(words)))


def places(book: TableBook) -> Mapping[str, slice]:
    """Where the members of a table of the book's export lie among its words."""
    record, found, begin = held_record(book), {}, 0
    for name in record.members:
        end = begin + int(np.prod(record.shape(name), dtype=int))
        found[name] = slice(begin, end)
        begin = end
    return found
