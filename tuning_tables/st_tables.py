"""The tables of a book as constants of the Structured Text blocks RETARDER_LOAD and RETARDER_SELECT."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from string import Template

import numpy as np

from tuning_tables.category_names import comment_text
from tuning_tables.st_any_time import any_time_blanks, gauge_constants, times_constants
from tuning_tables.st_approach import approach_blanks, approach_constants
from tuning_tables.st_blocks import LOAD_BODY, LOAD_DECLARATIONS, SELECT_BODY, SELECT_DECLARATIONS
from tuning_tables.st_estimator import estimator_blanks, estimator_constants
from tuning_tables.st_literals import bool_array, int_array, real_array
from tuning_tables.table_block import HAS_LOWER, HAS_UPPER, LAYOUT, BlockSize, TableBlock, block_of, block_size
from tuning_tables.table_book import TableBook


def blanks_of(book: TableBook) -> Mapping[str, str]:
    """The sizes that the templates ask for, by their names there."""
    size = block_size(book)
    numbers = {
        "STAGES": size.stages,
        "POWERS": size.powers,
        "STRIDE": 2 * size.powers,
        "LAYOUT": LAYOUT,
        "LAST_TABLE": len(book.tables) - 1,
        "LAST_STAGE": size.stages - 1,
        "LAST_COEFFICIENT": 2 * size.stages * size.powers - 1,
    }
    sizes = {name: str(number) for name, number in numbers.items()}
    return {**sizes, **estimator_blanks(book, size), **approach_blanks(size), **any_time_blanks(size)}


def load_block(book: TableBook) -> str:
    """RETARDER_LOAD: constants of every table, copied one by one."""
    blocks, size = _blocks(book), block_size(book)
    declarations = [
        int_array("StagesOf", [block.table.coefficients.shape[0] for block in blocks]),
        int_array("PowersOf", [block.table.coefficients.shape[2] for block in blocks]),
        real_array("TargetOf", [block.table.target_speed_m_s for block in blocks]),
        real_array("PathMinOf", [block.table.valid_range[0] for block in blocks]),
        real_array("PathMaxOf", [block.table.valid_range[1] for block in blocks]),
    ]
    for number, block in enumerate(blocks):
        declarations += _table_constants(book, number, block, size)
    declarations += approach_constants(blocks, size) + times_constants(blocks, size) + estimator_constants(book, size)
    blanks = blanks_of(book)
    case = Template(_CASE).safe_substitute(blanks)
    cases = "\n".join(Template(case).substitute(NUMBER=number) for number in range(len(blocks)))
    return "".join(
        [
            Template(LOAD_DECLARATIONS).substitute(blanks),
            constants(declarations),
            Template(LOAD_BODY).substitute(blanks, CASES=textwrap.indent(cases, " " * 4)),
        ]
    )


def select_block(book: TableBook) -> str:
    """RETARDER_SELECT: what the choice has to know of every table, and the choice."""
    blocks, blanks = _blocks(book), blanks_of(book)
    declarations = [
        int_array("CategoryOf", [block.category for block in blocks]),
        int_array("AxlesOf", [block.axles for block in blocks]),
        real_array("MassOf", [block.mass_t for block in blocks]),
        real_array("TargetOf", [block.table.target_speed_m_s for block in blocks]),
    ]
    body = Template(SELECT_BODY).substitute(blanks)
    return Template(SELECT_DECLARATIONS).substitute(blanks) + constants(declarations) + body


def constants(declarations: list[str]) -> str:
    """A block of constants, and the empty line before the statements."""
    return "\n".join(["VAR CONSTANT", *declarations, "END_VAR", "", ""])


def coefficients_of(block: TableBlock, size: BlockSize) -> np.ndarray[tuple[int], np.dtype[np.float32]]:
    """All coefficients of a block in the order of RETARDER_TABLE, float32 (stages * 2 * powers,)."""
    return block.words[size.coefficients].view(np.float32)


_CASE = """\
$NUMBER:
    FOR Index := 0 TO $LAST_STAGE DO
        Table.HasLower[Index] := Lower_$NUMBER[Index];
        Table.HasUpper[Index] := Upper_$NUMBER[Index];
    END_FOR;
    FOR Index := 0 TO $LAST_COEFFICIENT DO
        Table.Coefficient[Index] := Coefficient_$NUMBER[Index];
    END_FOR;$CASE_PRESSURES"""


def _blocks(book: TableBook) -> list[TableBlock]:
    size = block_size(book)
    return [block_of(book, number, size=size) for number in range(len(book.tables))]


def _table_constants(book: TableBook, number: int, block: TableBlock, size: BlockSize) -> list[str]:
    lines = block.words[4 : 4 + size.stages]
    return [
        f"    (* {number}: {comment_text(book.tables[number].id)} *)",
        bool_array(f"Lower_{number}", (lines & HAS_LOWER) > 0),
        bool_array(f"Upper_{number}", (lines & HAS_UPPER) > 0),
        real_array(f"Coefficient_{number}", coefficients_of(block, size), size.powers),
        *gauge_constants(number, block, size),
    ]
