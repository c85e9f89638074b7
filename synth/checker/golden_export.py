"""The golden vectors beside the controller code: each answer worked out anew from the table."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator, Sequence
from typing import Final

from synth.checker.finding import DamagedError
from synth.checker.float32 import decide, from_bits, rises
from synth.checker.source_file import rows_below
from synth.checker.table_reading import Table

VECTOR_HEAD: Final = ["table", "id", "stage", "s_m_bits", "v_m_s_bits", "answer", "s_m", "v_m_s"]
VECTOR_HEAD_WITH_GAUGE: Final = [*VECTOR_HEAD[:5], "pressure_kpa_bits", *VECTOR_HEAD[5:], "pressure_kpa"]
"""Where a table has slopes."""


def vector_differences(content: bytes, tables: Sequence[Table]) -> Iterator[tuple[str, str]]:
    """(about, sentence) for tables with wrong vectors, the first of each; `tables` in the order of the book."""
    has_gauge = any(table.has_gauge for table in tables)
    head = VECTOR_HEAD_WITH_GAUGE if has_gauge else VECTOR_HEAD
    rows = rows_below(head, content)
    seen: set[int] = set()
    wrong: set[int] = set()
    for place, row in enumerate(rows, start=2):
        try:
            number, name, stage = int(row[0]), row[1], int(row[2])
            s, v, answer = from_bits(int(row[3], 16)), from_bits(int(row[4], 16)), int(row[head.index("answer")])
            kpa = from_bits(int(row[5], 16)) if has_gauge else math.nan
            table = tables[number] if number >= 0 else None
        except (ValueError, IndexError, struct.error) as fault:
            raise DamagedError(f"row {place} is no golden vector: {fault}") from None
        if table is None:
            raise DamagedError(f"row {place} is of table {number}")
        seen.add(number)
        added = rises(table.slopes, table.pressures_kpa, table.top_stage, stage, kpa)
        right = decide(table.lines, table.path_m, table.entrance_stage, table.farthest, stage, s, v, added)
        if (name != table.id or right != answer) and number not in wrong:
            wrong.add(number)
            yield table.id, f"row {place} says {answer} of {name!r}, but the rule says {right} of {table.id!r}"
    for number, table in enumerate(tables):
        if number not in seen:
            yield table.id, "it has no golden vector"
