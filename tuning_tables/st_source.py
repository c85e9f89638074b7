"""Tables as IEC 61131-3 Structured Text: the types, the rule, the estimator, the choice, the data, and a self-test.

What is fixed in the text stands in `st_blocks`, `st_decide`, `st_estimate`, `st_observe` and `st_test_blocks`; how it
is used, in docs/structured-text.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from string import Template
from typing import Final

from tuning_tables.c_source import origin_lines
from tuning_tables.category_names import category_names, comment_text
from tuning_tables.errors import InvalidTable
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.self_test_size import FULL, SelfTestSize
from tuning_tables.st_any_time import any_time_blanks
from tuning_tables.st_approach import approach_blanks
from tuning_tables.st_blocks import CATEGORIES, HEAD, TABLE_TYPE
from tuning_tables.st_decide import DECIDE
from tuning_tables.st_estimate import ESTIMATE_TYPE
from tuning_tables.st_estimator import observe_blocks
from tuning_tables.st_self_test import self_test_blocks
from tuning_tables.st_tables import blanks_of, load_block, select_block
from tuning_tables.st_units import unit_files
from tuning_tables.table_block import LAYOUT, block_size
from tuning_tables.table_book import TableBook

MOST_TABLES: Final = 500
"""In one text: RETARDER_SELECT has arrays of that length, and compilers set limits of their own."""

TABLE_FILE: Final = "retarder_table.st"
SELF_TEST_FILE: Final = "retarder_self_test.st"

SELF_TEST_HEAD: Final = """\
(* Self-test of retarder_table.st, for the controller that is to run it. Generated: do not edit, export again.

   Call one instance of RETARDER_SELF_TEST once a cycle until Done; Failed must be 0. It compares every constant with a
   second copy, and the answers of RETARDER_DECIDE, RETARDER_SELECT and RETARDER_OBSERVE with those of the reference
   implementation: on every line, one float32 step beside it, at both ends of the path, and over whole cuts. Readings
   that are not finite or denormal are left out, because they have no portable literal. Remove the blocks after the test
   if memory is short. *)
"""


def st_files(book: TableBook, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL) -> Mapping[str, bytes]:
    """The files of the export by name, ASCII with LF: the tables with their blocks, and the self-test.

    Equal books give equal bytes. Raises `InvalidTable` for more than `MOST_TABLES` tables, and for a category without
    number.
    """
    files = {
        TABLE_FILE: "\n".join([head(book), *table_units(book)]),
        SELF_TEST_FILE: "\n".join([SELF_TEST_HEAD, *self_test_blocks(book, self_test)]),
    }
    return {prefix.renamed(name): prefix.renamed(text).encode("ascii") for name, text in files.items()}


def st_unit_files(
    book: TableBook, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL
) -> Mapping[str, bytes]:
    """The same units, a file each; by their names in the order in which they need each other. Raises as `st_files`."""
    texts = [prefix.renamed(text) for text in (*table_units(book), *self_test_blocks(book, self_test))]
    texts[0] = "\n".join([prefix.renamed(head(book)), texts[0]])
    return unit_files(texts)


def head(book: TableBook) -> str:
    """The comment at the beginning."""
    origin = "\n".join(f"   {line}" for line in origin_lines(book))
    categories = "\n".join(category_lines(book))
    size = block_size(book)
    blanks = {**approach_blanks(size), **any_time_blanks(size)}
    return HEAD.substitute(blanks, ORIGIN=origin, CATEGORIES=categories, LAYOUT=LAYOUT)


def table_units(book: TableBook) -> list[str]:
    """Types and blocks of the tables, each a text of its own, none before one that it needs."""
    _require_exportable(book)
    blanks = blanks_of(book)
    return [
        Template(Template(TABLE_TYPE).safe_substitute(blanks)).substitute(blanks),
        ESTIMATE_TYPE,
        categories_block(book),
        load_block(book),
        select_block(book),
        *observe_blocks(blanks),
        Template(DECIDE).substitute(blanks),
    ]


def category_lines(book: TableBook) -> list[str]:
    """The number of every weight category, for the head comment."""
    return [
        f"   {each.number:9d}  {each.macro}, in tables {comment_text(each.category)}".rstrip()
        for each in category_names(book.exported_numbers())
    ]


def categories_block(book: TableBook) -> str:
    """RETARDER_CATEGORIES: an output for every category, with its number from the start on."""
    names = category_names(book.exported_numbers())
    return Template(CATEGORIES).substitute(
        LAYOUT=LAYOUT,
        DECLARED="\n".join(
            f"    Category_{each.macro} : INT := {each.number}; (* {comment_text(each.category)} *)" for each in names
        ),
        ASSIGNED="\n".join(f"Category_{each.macro} := {each.number};" for each in names),
    )


def _require_exportable(book: TableBook) -> None:
    if len(book.tables) > MOST_TABLES:
        raise InvalidTable(
            f"the book has {len(book.tables)} tables, but Structured Text holds at most {MOST_TABLES}: "
            "export fewer classes or targets at a time."
        )
