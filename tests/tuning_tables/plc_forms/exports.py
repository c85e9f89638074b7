"""An export of every kind, as small as it shows what may go wrong, and the self-test run as a controller does."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import Final

from tests.controller_code.passage_tables import every_axle_book, passage_book
from tests.controller_code.sample_book import approaching_book, estimating_book, park_book, surface_book
from tests.tuning_tables.aim.made_tables import category_table, measured_table
from tests.tuning_tables.st.conftest import oddly_named_book
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.exported_forms import MOST_CALLS, default_book
from tests.tuning_tables.st.syntax import MATIEC
from tuning_tables.aim import AimTables
from tuning_tables.aim.exports import aim_export
from tuning_tables.correction import Correction
from tuning_tables.export_names import RETARDER, ExportPrefix
from tuning_tables.exports import correction_export, line_export
from tuning_tables.language.st_unit import Export
from tuning_tables.passages.exports import passage_export
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.self_test_size import SMALL
from tuning_tables.table_book import TableBook

PARK: Final = ExportPrefix("PARK_2")
LONGEST: Final = ExportPrefix("TENLETTERS")


def _lines(book: TableBook, prefix: ExportPrefix) -> Export:
    return line_export(book, prefix, SMALL)


def _named(book: TableBook, *ids: str) -> TableBook:
    return TableBook(tuple(table for table in book.tables if table.id in ids))


def _passages(prefix: ExportPrefix) -> Export:
    tables = (passage_book().tables[0], passage_book().tables[5])
    return passage_export(PassageBook(tables), prefix, SMALL)


def _every_axle(prefix: ExportPrefix) -> Export:
    return passage_export(PassageBook(every_axle_book().tables[:1]), prefix, SMALL)


def _aims(prefix: ExportPrefix) -> Export:
    return aim_export(AimTables((measured_table(), category_table(1.5, 4, "СТ"))), prefix, SMALL)


KINDS: Final[Mapping[str, Callable[[ExportPrefix], Export]]] = {
    "book": lambda prefix: _lines(default_book(), prefix),
    "one table": lambda prefix: _lines(TableBook(default_book().tables[:1]), prefix),
    "two classes": lambda prefix: _lines(park_book(), prefix),
    "estimators": lambda prefix: _lines(_named(estimating_book(), "many-stages", "odd"), prefix),
    "approach": lambda prefix: _lines(_named(approaching_book(False), "shadow-1.5", "turning"), prefix),
    "slopes": lambda prefix: _lines(_named(surface_book(approaching_book(False)), "shadow-1.5", "odd"), prefix),
    "odd names": lambda prefix: _lines(oddly_named_book(), prefix),
    "point sensors": _passages,
    "every axle": _every_axle,
    "aim": _aims,
    "correction": lambda prefix: correction_export(Correction(0.12, 0.06), prefix),
}


@cache
def exported(kind: str, prefix: ExportPrefix = RETARDER) -> Export:
    """The export of a kind, made once."""
    return KINDS[kind](prefix)


def self_test_of(export: Export) -> str:
    """The block that runs all tests: the last one."""
    return export[-1].units[-1].name


def failed(text: bytes, self_test: str) -> int:
    """How many blocks of the self-test in a text find something wrong, run as MATIEC runs it."""
    program = Program(text, MATIEC)
    instance = program.new(self_test)
    for _ in range(MOST_CALLS):
        program.call(self_test, instance, Restart=False)
        if instance["DONE"].value:
            return int(instance["FAILED"].value)
    raise AssertionError(f"{self_test} is not done after {MOST_CALLS} calls")
