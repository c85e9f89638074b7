"""Tables for point sensors as controller code, in C99 and in IEC 61131-3 Structured Text: tracker, rule and step,
the data, the choice, and a self-test.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import prod
from typing import Final

from tuning_tables.controller_code.code import ControllerCode
from tuning_tables.controller_code.passage_code import passage_code
from tuning_tables.controller_code.st_self_test import st_export
from tuning_tables.errors import InvalidTable
from tuning_tables.export_names import RETARDER, ExportPrefix
from tuning_tables.exports import c_texts, golden_csv_of_tables
from tuning_tables.language.st_unit import Export
from tuning_tables.passages.golden_passages import golden_passages
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.self_test_size import FULL, SelfTestSize


def passage_c_files(
    book: PassageBook, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL
) -> Mapping[str, bytes]:
    """The files of the export by name: four of C99, ASCII, and all golden rows as CSV for other languages.

    Equal books give equal bytes. Raises `InvalidTable` for a category without number.
    """
    golden = [golden_passages(table) for table in book.tables]
    rows = {
        "golden_stages.csv": [each.stages for each in golden],
        "golden_pairs.csv": [each.pairs for each in golden],
        "golden_pulses.csv": [each.pulses for each in golden],
    }
    csv = {}
    for name, golden_rows in rows.items():
        columns = [{field: each[field] for field in each.dtype.names or ()} for each in golden_rows]
        csv[prefix.data_file(name)] = golden_csv_of_tables([table.id for table in book.tables], columns)
    return {**c_texts(passage_code(book, self_test), prefix), **csv}


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
