"""Whether the tables of a book agree on the numbers of their weight categories."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from synth.checker.passages.reading import PassageTable
from synth.checker.table_reading import Table


def without_number(tables: Sequence[Table | PassageTable]) -> Iterator[tuple[str, str]]:
    """(id, sentence) for each table whose category no controller code can name."""
    for table in tables:
        if table.category_number is None:
            yield table.id, f"its category {table.category} has no number, so it makes no controller code"


def contradictions(tables: Sequence[Table | PassageTable]) -> Iterator[tuple[str, str]]:
    """(id, sentence) where a name has two numbers, or a number two names."""
    names: dict[str, Table | PassageTable] = {}
    numbers: dict[int, Table | PassageTable] = {}
    for table in tables:
        first = names.setdefault(table.category, table)
        if first.category_number != table.category_number:
            yield table.id, f"its category {table.category} has another number than in {first.id}"
        if table.category_number is not None:
            first = numbers.setdefault(table.category_number, table)
            if first.category != table.category:
                yield table.id, f"the number of its category {table.category} is that of {first.category} in {first.id}"
