"""Tables as IEC 61131-3 Structured Text: the types, the rules, the data, the choice, and a self-test.

How it is used stands in docs/structured-text.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tuning_tables.controller_code.c_self_test import test_stem
from tuning_tables.controller_code.code import ControllerCode
from tuning_tables.controller_code.line_code import line_code
from tuning_tables.controller_code.st_code import head, st_units
from tuning_tables.controller_code.st_self_test import self_test_head, st_test_units
from tuning_tables.errors import InvalidTable
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.self_test_size import FULL, SelfTestSize
from tuning_tables.st_units import unit_files
from tuning_tables.table_book import TableBook

MOST_TABLES: Final = 500
"""In one text: the choice has arrays of that length, and compilers set limits of their own."""

TABLE_FILE: Final = "retarder_table.st"
SELF_TEST_FILE: Final = "retarder_self_test.st"


def st_files(book: TableBook, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL) -> Mapping[str, bytes]:
    """The files of the export by name, ASCII with LF: the tables with their blocks, and the self-test.

    Equal books give equal bytes. Raises `InvalidTable` for more than `MOST_TABLES` tables, and for a category without
    number.
    """
    return st_texts(_exportable(book, self_test), prefix, self_test.line_checks)


def st_unit_files(
    book: TableBook, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL
) -> Mapping[str, bytes]:
    """The same units, a file each; by their names in the order in which they need each other. Raises as `st_files`."""
    return st_unit_texts(_exportable(book, self_test), prefix, self_test.line_checks)


def st_texts(code: ControllerCode, prefix: ExportPrefix, line_checks: int = 0) -> Mapping[str, bytes]:
    """The two files of any export, by name."""
    files = {
        f"retarder_{code.stem}.st": "\n".join([head(code), *st_units(code)]),
        f"retarder_{test_stem(code)}.st": "\n".join([self_test_head(code), *st_test_units(code, line_checks)]),
    }
    return {prefix.renamed(name): prefix.renamed(text).encode("ascii") for name, text in files.items()}


def st_unit_texts(code: ControllerCode, prefix: ExportPrefix, line_checks: int = 0) -> Mapping[str, bytes]:
    """The units of any export, a file each, in the order in which they need each other."""
    texts = [prefix.renamed(text) for text in (*st_units(code), *st_test_units(code, line_checks))]
    texts[0] = "\n".join([prefix.renamed(head(code)), texts[0]])
    return unit_files(texts)


def _exportable(book: TableBook, self_test: SelfTestSize) -> ControllerCode:
    if len(book.tables) > MOST_TABLES:
        raise InvalidTable(
            f"the book has {len(book.tables)} tables, but Structured Text holds at most {MOST_TABLES}: "
            "export fewer classes or targets at a time."
        )
    return line_code(book, self_test)
