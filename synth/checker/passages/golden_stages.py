"""The golden stages beside code for point sensors: each answer worked out anew from the table."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from typing import Final

from synth.checker.finding import DamagedError
from synth.checker.float32 import from_bits
from synth.checker.passages.reading import PassageTable
from synth.checker.passages.rule import wanted
from synth.checker.source_file import rows_below

HEAD: Final = ["table", "id", "passage", "stage", "reading_m_s_bits", "wanted", "reading_m_s"]


def stage_differences(content: bytes, tables: Sequence[PassageTable]) -> Iterator[tuple[str, str]]:
    """(about, sentence) for tables with wrong stages, the first of each."""
    rows = rows_below(HEAD, content)
    by_id = {table.id: table for table in tables}
    seen: set[str] = set()
    wrong: set[str] = set()
    for place, row in enumerate(rows, start=2):
        try:
            name, passage, stage, answer = row[1], int(row[2]), int(row[3]), int(row[5])
            v_m_s, table = from_bits(int(row[4], 16)), by_id[name]
        except (ValueError, IndexError, KeyError, struct.error) as fault:
            raise DamagedError(f"row {place} is no golden stage of a table: {fault}") from None
        seen.add(name)
        right = wanted(table, passage, stage, v_m_s)
        if answer != right and name not in wrong:
            wrong.add(name)
            yield name, f"row {place} says {answer}, but the rule says {right}"
    yield from ((table.id, "it has no golden stage") for table in tables if table.id not in seen)
