"""Numbers of weight categories in tables and controller code, as docs/table-format.md fixes them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final

from synth.checker.document_shape import refuse_unless

if TYPE_CHECKING:
    from synth.checker.table_reading import Table

YARD: Final = {"Л": 1, "ЛС": 2, "С": 3, "СТ": 4, "Т": 5}
OWN: Final = range(16, 256)


def number_of(cut: dict[str, Any]) -> int | None:
    """The number of the category of a cut: stated, or that of the yard's own; None for neither.

    Raises `DamagedError` where another one is stated.
    """
    stated, known = cut.get("category_number"), YARD.get(cut["category"])
    if stated is None:
        return known
    right = stated == known if known is not None else stated in OWN
    wanted = str(known) if known is not None else "from 16 to 255"
    refuse_unless(right, stated, f"cut.category_number of {cut['category']}", wanted)
    return int(stated)


def without_number(tables: Sequence[Table]) -> Iterator[tuple[str, str]]:
    """(id, sentence) for each table whose category no controller code can name."""
    for table in tables:
        if table.category_number is None:
            yield table.id, f"its category {table.category} has no number, so it makes no controller code"


def contradictions(tables: Sequence[Table]) -> Iterator[tuple[str, str]]:
    """(id, sentence) where a name has two numbers, or a number two names."""
    names: dict[str, Table] = {}
    numbers: dict[int, Table] = {}
    for table in tables:
        first = names.setdefault(table.category, table)
        if first.category_number != table.category_number:
            yield table.id, f"its category {table.category} has another number than in {first.id}"
        if table.category_number is not None:
            first = numbers.setdefault(table.category_number, table)
            if first.category != table.category:
                yield table.id, f"the number of its category {table.category} is that of {first.category} in {first.id}"
