"""The Structured Text self-test: a block for every table with golden vectors, one for the choice, one that runs all.

The blocks for the estimators are in `st_test_estimators`.

Only readings that have a portable literal are in it: no NaN, no infinity, no denormal number (a controller may take
those for 0). What the text answers to them is tested in this project, on the parse tree, and not on the controller.
"""

from __future__ import annotations

from collections.abc import Iterator
from string import Template

import numpy as np
import numpy.typing as npt

from tuning_tables.category_names import comment_text
from tuning_tables.distinct_estimators import distinct_estimators
from tuning_tables.golden_choices import GoldenChoice, golden_choices
from tuning_tables.golden_vectors import GoldenVectors
from tuning_tables.self_test_size import SelfTestSize
from tuning_tables.st_any_time import slopes_agree, times_check
from tuning_tables.st_approach import approach_check
from tuning_tables.st_literals import LONGEST_ARRAY, int_array, is_portable, real, real_array
from tuning_tables.st_tables import coefficients_of, constants
from tuning_tables.st_test_blocks import (
    CHOICE_HEAD,
    CHOICE_LINES,
    CHOICE_LOOP,
    FOOT,
    RESET,
    TABLE_CONSTANTS,
    TABLE_HEAD,
    TABLE_LOOP,
)
from tuning_tables.st_test_estimators import estimator_check, estimator_test
from tuning_tables.st_test_order import run_all
from tuning_tables.table_block import block_of, block_size
from tuning_tables.table_book import Choice, Status, TableBook


def self_test_blocks(book: TableBook, self_test: SelfTestSize) -> Iterator[str]:
    """The blocks of retarder_self_test.st, in an order in which none is used before it is declared."""
    found = distinct_estimators(book)
    for number, table in enumerate(book.tables):
        yield _table_test(book, number, found.of_table[number], self_test.vectors(table))
    yield _choice_test(book, self_test.line_checks)
    for place, number in enumerate(found.first_tables):
        yield estimator_test(book, place, number)
    yield run_all(book)


def _table_test(book: TableBook, number: int, estimator: int, vectors: GoldenVectors) -> str:
    """RETARDER_TEST_n: the constants of the table once more, the number of its estimator, and golden vectors."""
    size = block_size(book)
    block = block_of(book, number, size=size)
    expected = [block.table.target_speed_m_s, *block.table.valid_range[:2], *coefficients_of(block, size)]
    # Without slopes no pressure changes an answer, so any will do.
    kpa = vectors.pressure_kpa if book.tables[number].has_gauge else np.zeros_like(vectors.pressure_kpa)
    kept = np.flatnonzero(is_portable(vectors.s_m) & is_portable(vectors.v_m_s) & is_portable(kpa))
    blanks = {"NUMBER": number, "NAME": comment_text(book.tables[number].id), "LAST": len(expected) - 4}
    declarations, statements = [real_array("Expected", expected)], [Template(TABLE_CONSTANTS).substitute(blanks)]
    if size.breaks:
        statements.append(estimator_check(book, number, estimator))
    if size.approach:
        statements.append(approach_check(block))
    for already, more in zip((declarations, statements), times_check(block, size), strict=True):
        already += more
    first = len(expected)
    for part, chosen in _parts(kept):
        declarations += [
            int_array(f"Stage_{part}", vectors.stage[chosen]),
            real_array(f"Path_{part}", vectors.s_m[chosen]),
            real_array(f"Speed_{part}", vectors.v_m_s[chosen]),
            int_array(f"Answer_{part}", vectors.answer[chosen]),
        ]
        asked = ""
        if size.gauge:
            declarations.append(real_array(f"Pressure_{part}", kpa[chosen]))
            asked = f"\n        Pressure_kpa := Pressure_{part}[Index],"
        loop = Template(TABLE_LOOP)
        statements.append(loop.substitute(PART=part, LAST=len(chosen) - 1, FIRST=first, PRESSURE_ASKED=asked))
        first += len(chosen)
    head = Template(TABLE_HEAD).substitute(blanks, CONSTANTS=len(expected), READINGS=len(kept))
    return "".join([head, constants(declarations), RESET, *statements, FOOT])


def _choice_test(book: TableBook, line_checks: int) -> str:
    """RETARDER_TEST_CHOICES: golden choices by status and target, some of them by every coefficient."""
    choices = [choice for choice in golden_choices(book) if is_portable(np.array([choice.commanded_m_s]))[0]]
    declarations, statements = [], []
    for part, chosen in _parts(np.arange(len(choices))):
        rows = [choices[index] for index in chosen]
        declarations += [
            int_array(f"Layout_{part}", [row.layout for row in rows]),
            int_array(f"Category_{part}", [row.category for row in rows]),
            int_array(f"Axles_{part}", [row.axles for row in rows]),
            real_array(f"Commanded_{part}", [row.commanded_m_s for row in rows]),
            int_array(f"Status_{part}", [row.status for row in rows]),
            real_array(f"Target_{part}", [_target(book, row) for row in rows]),
        ]
        statements.append(Template(CHOICE_LOOP).substitute(PART=part, LAST=len(rows) - 1, FIRST=chosen[0]))
    size = block_size(book)
    between = [row for row in choices if row.status == Status.BETWEEN][::3][:line_checks]
    for number, row in enumerate(between):
        choice = _choose(book, row)
        block = block_of(book, choice.numbers[0], choice.table, size)
        expected = coefficients_of(block, size)
        slopes, slopes_checked = slopes_agree(number, block, size)
        declarations += [real_array(f"Expected_{number}", expected), *slopes]
        statements.append(
            Template(CHOICE_LINES).substitute(
                NUMBER=number,
                LAYOUT=row.layout,
                CATEGORY=row.category,
                AXLES=row.axles,
                COMMANDED=real(row.commanded_m_s),
                LAST=len(expected) - 1,
                FAULT=len(choices) + number,
                SLOPES_AGREE=slopes_checked,
            )
        )
    head = Template(CHOICE_HEAD).substitute(CHOICES=len(choices), LINES=len(between))
    return "".join([head, constants(declarations), RESET, *statements, FOOT])


def _choose(book: TableBook, row: GoldenChoice) -> Choice:
    category = next(name for name, number in book.category_numbers.items() if number == row.category)
    return book.choose(category, row.axles, float(row.commanded_m_s))


def _target(book: TableBook, row: GoldenChoice) -> np.float32:
    """The target of the chosen table, 0 for none."""
    table = None if row.status < 0 else _choose(book, row).table
    return np.float32(0) if table is None else table.target_speed_m_s


def _parts(indices: npt.NDArray[np.intp]) -> Iterator[tuple[int, npt.NDArray[np.intp]]]:
    """Runs of `indices`, numbered, none longer than an array may be."""
    for part, start in enumerate(range(0, len(indices), LONGEST_ARRAY)):
        yield part, indices[start : start + LONGEST_ARRAY]
