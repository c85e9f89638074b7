"""Tables as IEC 61131-3 Structured Text: the types, the rules, the data, the choice, and a self-test.

How it is used stands in docs/reference/structured-text.md.
"""

from __future__ import annotations

from typing import Final

from tuning_tables.controller_code.line_code import line_code
from tuning_tables.controller_code.st_export import st_export
from tuning_tables.errors import InvalidTable
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.language.st_unit import Export
from tuning_tables.self_test_size import FULL, SelfTestSize
from tuning_tables.table_book import TableBook

MOST_TABLES: Final = 500
"""In one text: the choice has arrays of that length, and compilers set limits of their own."""

TABLE_FILE: Final = "retarder_table.st"
SELF_TEST_FILE: Final = "retarder_self_test.st"


def line_export(book: TableBook, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL) -> Export:
    """The tables with their blocks, and the self-test, to be laid out in any form.

    Raises `InvalidTable` for more than `MOST_TABLES` tables, and for a category without number.
    """
    if len(book.tables) > MOST_TABLES:
        raise InvalidTable(
            f"the book has {len(book.tables)} tables, but Structured Text holds at most {MOST_TABLES}: "
            "export fewer classes or targets at a time."
        )
    return st_export(line_code(book, self_test), prefix, self_test.line_checks)
