"""Tables for point sensors as IEC 61131-3 Structured Text: types, tracker, rule, step, the data, and a self-test."""

from __future__ import annotations

from collections.abc import Mapping
from math import prod
from typing import Final

from tuning_tables.controller_code.code import ControllerCode
from tuning_tables.controller_code.passage_code import Ask, passage_code
from tuning_tables.controller_code.st_code import head, st_units
from tuning_tables.controller_code.st_self_test import self_test_head, st_test_units
from tuning_tables.errors import InvalidTable
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.passages.golden_passages import golden_passages
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.st_units import unit_files

TABLE_FILE: Final = "retarder_passages.st"
SELF_TEST_FILE: Final = "retarder_passages_self_test.st"

MOST_TABLES: Final = 500
LARGEST_INT: Final = 32767


def passage_st_files(
    book: PassageBook, prefix: ExportPrefix = RETARDER, ask: Ask = golden_passages
) -> Mapping[str, bytes]:
    """The files by name, ASCII with LF: the tables with their blocks, and the self-test. Equal books, equal bytes.

    `ask`: what the self-test asks. Raises `InvalidTable` for a category without number, and for what 16 bits do not
    count.
    """
    code = _exportable(book, ask)
    files = {
        TABLE_FILE: "\n".join([head(code), *st_units(code)]),
        SELF_TEST_FILE: "\n".join([self_test_head(code), *st_test_units(code, 0)]),
    }
    return {prefix.renamed(name): prefix.renamed(text).encode("ascii") for name, text in files.items()}


def passage_st_unit_files(
    book: PassageBook, prefix: ExportPrefix = RETARDER, ask: Ask = golden_passages
) -> Mapping[str, bytes]:
    """The same units, a file each; by their names in the order in which they need each other. Raises as above."""
    code = _exportable(book, ask)
    first, *others = st_units(code)
    texts = ["\n".join([head(code), first]), *others, *st_test_units(code, 0)]
    return unit_files([prefix.renamed(text) for text in texts])


def _exportable(book: PassageBook, ask: Ask) -> ControllerCode:
    code = passage_code(book, ask)
    speeds = prod(code.room[axis] for axis in ("passages", "stages", "thresholds"))
    if len(book.tables) > MOST_TABLES or speeds > LARGEST_INT:
        raise InvalidTable(
            f"there are {len(book.tables)} tables, of up to {speeds} switching speeds each, but Structured Text holds "
            f"at most {MOST_TABLES} tables and counts to {LARGEST_INT}: export fewer, or tables of one shape, at a "
            "time."
        )
    return code
