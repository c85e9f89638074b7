"""Tables for point sensors as IEC 61131-3 Structured Text: types, tracker, rule, step, the data, and a self-test."""

from __future__ import annotations

from math import prod
from typing import Final

from tuning_tables.controller_code.code import ControllerCode
from tuning_tables.controller_code.passage_code import passage_code
from tuning_tables.controller_code.st_export import st_export
from tuning_tables.errors import InvalidTable
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.language.st_unit import Export
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.self_test_size import FULL, SelfTestSize

TABLE_FILE: Final = "retarder_passages.st"
SELF_TEST_FILE: Final = "retarder_passages_self_test.st"

MOST_TABLES: Final = 500
LARGEST_INT: Final = 32767


def passage_export(book: PassageBook, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL) -> Export:
    """The tables with their blocks, and the self-test, to be laid out in any form.

    Raises `InvalidTable` for a category without number, and for what 16 bits do not count.
    """
    return st_export(_exportable(book, self_test), prefix)


def _exportable(book: PassageBook, self_test: SelfTestSize) -> ControllerCode:
    code = passage_code(book, self_test)
    speeds = prod(code.room[axis] for axis in ("passages", "stages", "thresholds"))
    if len(book.tables) > MOST_TABLES or speeds > LARGEST_INT:
        raise InvalidTable(
            f"there are {len(book.tables)} tables, of up to {speeds} switching speeds each, but Structured Text holds "
            f"at most {MOST_TABLES} tables and counts to {LARGEST_INT}: export fewer, or tables of one shape, at a "
            "time."
        )
    return code
