"""Tables as IEC 61131-3 Structured Text: the types, the rule, the estimator, the choice, the data, and a self-test.

What is fixed in the text stands in `st_blocks`, `st_observe` and `st_test_blocks`; how it is used, in
docs/structured-text.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from string import Template
from typing import Final

from tuning_tables.c_source import origin_lines
from tuning_tables.category_names import category_macros, comment_text
from tuning_tables.errors import InvalidTable
from tuning_tables.st_blocks import DECIDE, HEAD, TABLE_TYPE
from tuning_tables.st_estimator import observe_blocks
from tuning_tables.st_observe import ESTIMATE_TYPE
from tuning_tables.st_self_test import self_test_blocks
from tuning_tables.st_tables import blanks_of, load_block, select_block
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


def st_files(book: TableBook) -> Mapping[str, bytes]:
    """The files of the export by name, ASCII with LF: the tables with their blocks, and the self-test.

    Equal books give equal bytes. Raises `InvalidTable` for more than `MOST_TABLES` tables.
    """
    _require_exportable(book)
    blanks = blanks_of(book)
    origin = "\n".join(f"   {line}" for line in origin_lines(book))
    blocks = [
        HEAD.substitute(ORIGIN=origin, CATEGORIES="\n".join(category_lines(book))),
        Template(Template(TABLE_TYPE).safe_substitute(blanks)).substitute(blanks),
        ESTIMATE_TYPE,
        load_block(book),
        select_block(book),
        *observe_blocks(blanks),
        Template(DECIDE).substitute(blanks),
    ]
    return {
        TABLE_FILE: "\n".join(blocks).encode("ascii"),
        SELF_TEST_FILE: "\n".join([SELF_TEST_HEAD, *self_test_blocks(book)]).encode("ascii"),
    }


def category_lines(book: TableBook) -> list[str]:
    """The number of every weight category, for the head comment."""
    names = category_macros(book.categories)
    return [
        f"   {number:9d}  {name}, in the book {comment_text(category)}".rstrip()
        for number, (name, category) in enumerate(zip(names, book.categories, strict=True), start=1)
    ]


def _require_exportable(book: TableBook) -> None:
    if len(book.tables) > MOST_TABLES:
        raise InvalidTable(
            f"the book has {len(book.tables)} tables, but Structured Text holds at most {MOST_TABLES}: "
            "export fewer classes or targets at a time."
        )
