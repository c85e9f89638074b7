"""Tables for point sensors as IEC 61131-3 Structured Text: types, rule, tracker, step, the data, and a self-test.

What is fixed in the text stands in `st_blocks`, `st_tracker` and `st_self_test`.
"""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from string import Template
from typing import Final

import numpy as np

from tuning_tables.category_names import comment_text
from tuning_tables.errors import InvalidTable
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.passages.c_source import Ask
from tuning_tables.passages.export_head import category_texts, origin_lines
from tuning_tables.passages.golden_passages import golden_passages
from tuning_tables.passages.passage_block import PassageBlockSize, exported_number, passage_block_size
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.regulator import SHORTEST_READING_S
from tuning_tables.passages.st_blocks import (
    AT_PULSE,
    BEGIN,
    HEAD,
    LOAD_BODY,
    LOAD_DECLARATIONS,
    TABLE_TYPE,
    TRACKER_TYPE,
    WANTED,
)
from tuning_tables.passages.st_members import COUNTS, NUMBERS, arrays_of, counts_of, numbers_of, parts_of
from tuning_tables.passages.st_select import SELECT_BODY, SELECT_DECLARATIONS
from tuning_tables.passages.st_self_test import SELF_TEST_HEAD, self_test_blocks
from tuning_tables.passages.st_tracker import BELIEVED, NEXT
from tuning_tables.passages.tracker import LONGEST_WAIT_S
from tuning_tables.st_literals import GREATEST_REAL, constants, int_array, real_array, real_constant
from tuning_tables.st_loops import without_single_turns
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
    files = {
        TABLE_FILE: "\n".join([_head(book), *_units(book)]),
        SELF_TEST_FILE: "\n".join([SELF_TEST_HEAD, *self_test_blocks(book, ask)]),
    }
    return {prefix.renamed(name): prefix.renamed(text).encode("ascii") for name, text in files.items()}


def passage_st_unit_files(
    book: PassageBook, prefix: ExportPrefix = RETARDER, ask: Ask = golden_passages
) -> Mapping[str, bytes]:
    """The same units, a file each; by their names in the order in which they need each other. Raises as above."""
    first, *others = _units(book)
    texts = ["\n".join([_head(book), first]), *others, *self_test_blocks(book, ask)]
    return unit_files([prefix.renamed(text) for text in texts])


def _head(book: PassageBook) -> str:
    return HEAD.substitute(
        ORIGIN="\n".join(f"   {line}" for line in origin_lines(book)),
        CATEGORIES="\n".join(
            f"   {number:9d}  {macro}, in tables {name}".rstrip() for macro, number, name in category_texts(book)
        ),
    )


def _units(book: PassageBook) -> list[str]:
    """Types and blocks, each a text of its own, none before one that it needs."""
    tables, size = book.tables, passage_block_size(book.tables)
    _require_countable(tables, size)
    numbers = {
        "HEARD": size.heard,
        "PASSAGES": size.passages,
        "STAGES": size.stages,
        "SPEEDS": size.stages - 1,
        "LAST_TABLE": len(tables) - 1,
        "LAST_HEARD": size.heard - 1,
        "LAST_SPEED": size.passages * size.stages * (size.stages - 1) - 1,
    }
    blanks = {name: str(number) for name, number in numbers.items()}
    blanks |= {
        "GREATEST_REAL": GREATEST_REAL,
        "LONGEST_WAIT": real_constant("LongestWait_s", LONGEST_WAIT_S),
        "SHORTEST_READING": real_constant("ShortestReading_s", SHORTEST_READING_S),
    }
    fixed = (TABLE_TYPE, TRACKER_TYPE, BEGIN, WANTED, NEXT, BELIEVED, AT_PULSE)
    blocks = [*(Template(text).substitute(blanks) for text in fixed), _load_block(tables, size, blanks)]
    return [without_single_turns(text) for text in (*blocks, _select_block(tables, blanks))]


def _select_block(tables: Sequence[PassageTable], blanks: Mapping[str, str]) -> str:
    """RETARDER_SELECT_PASSAGES: what the choice has to know of every table, and the choice."""
    declarations = [
        GREATEST_REAL,
        int_array("CategoryOf", [exported_number(table) for table in tables]),
        int_array("AxlesOf", [len(table.cut.axle_offsets_m) for table in tables]),
        real_array("MassOf", [table.cut.mass_t for table in tables]),
        real_array("TargetOf", [table.target_speed_m_s for table in tables]),
    ]
    return SELECT_DECLARATIONS + constants(declarations) + Template(SELECT_BODY).substitute(blanks)


def _require_countable(tables: Sequence[PassageTable], size: PassageBlockSize) -> None:
    speeds = size.passages * size.stages * (size.stages - 1)
    if len(tables) > MOST_TABLES or speeds > LARGEST_INT:
        raise InvalidTable(
            f"there are {len(tables)} tables, of up to {speeds} switching speeds each, but Structured Text holds at "
            f"most {MOST_TABLES} tables and counts to {LARGEST_INT}: export fewer, or tables of one shape, at a time."
        )


def _load_block(tables: Sequence[PassageTable], size: PassageBlockSize, blanks: Mapping[str, str]) -> str:
    """RETARDER_LOAD_PASSAGES: constants of every table, copied one by one."""
    numbers, counts = (np.array([row(table) for table in tables]) for row in (numbers_of, counts_of))
    declarations = [real_array(f"{name}Of", column) for name, column in zip(NUMBERS, numbers.T, strict=True)]
    declarations += [int_array(f"{name}Of", column) for name, column in zip(COUNTS, counts.T, strict=True)]
    cases = []
    for number, table in enumerate(tables):
        declarations.append(f"    (* {number}: {comment_text(table.id)} *)")
        lines = [f"{number}:"]
        for member, values in arrays_of(table, size):
            array = int_array if values.dtype == np.int64 else real_array
            for part, start, piece in parts_of(values):
                name, place = f"{member}_{number}_{part}", f"Index + {start}" if start else "Index"
                declarations.append(array(name, piece))
                lines += [
                    f"    FOR Index := 0 TO {len(piece) - 1} DO",
                    f"        Table.{member}[{place}] := {name}[Index];",
                    "    END_FOR;",
                ]
        cases.append("\n".join(lines))
    members = "\n".join(f"    Table.{name} := {name}Of[TableNo];" for name in (*NUMBERS, *COUNTS))
    body = Template(LOAD_BODY).substitute(blanks, MEMBERS=members, CASES=textwrap.indent("\n".join(cases), " " * 4))
    return Template(LOAD_DECLARATIONS).substitute(blanks) + constants(declarations) + body
