"""The controller code of tables of any kind against what it must hold: the same members in C99 and for PLCs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from synth.checker.category_constants import category_differences
from synth.checker.code_file import CodeKind
from synth.checker.code_records import Numbers, c_members, c_numbers, c_records, checksum_fault, st_records
from synth.checker.code_records import differences as record_differences
from synth.checker.export_check import Differences
from synth.checker.finding import DamagedError


class Due(NamedTuple):
    """What an export must hold: by table, in the order of the export, its id and its numbers.

    `categories`: numbers of weight categories by name.
    """

    ids: Sequence[str]
    numbers: Sequence[Numbers]
    categories: Mapping[str, int]


def c_differences(source: str, header: str, word: str, kind: CodeKind, due: Due) -> Differences:
    """(about, sentence) for each disagreement of a source in C; "" about the code."""
    record = f"{word}_{kind.record}".lower()
    members = c_members(header, record)
    blocks = c_records(source, members, f"{record}s", f"{record}_count")
    require_whole(source)
    yield from (("", sentence) for sentence in category_differences(word, due.categories, header))
    for number, (name, block) in enumerate(zip(due.ids, blocks, strict=False)):
        fault = checksum_fault(number, block)
        if fault is not None:
            yield name, fault
    yield from table_differences([c_numbers(members, block) for block in blocks], due)


def require_whole(source: str) -> None:
    """`DamagedError` unless a source in C ends behind a function."""
    if not source.endswith("\n}\n"):
        raise DamagedError("it does not end as an export does")


def st_differences(text: str, word: str, kind: CodeKind, due: Due) -> Differences:
    """(about, sentence) for each disagreement of Structured Text."""
    records = st_records(text, f"{word}_{kind.record}", f"{word}_{kind.load}")
    yield from (("", fault) for fault in records.faults)
    yield from table_differences(records.tables, due)


def table_differences(tables: Sequence[Numbers], due: Due) -> Differences:
    """What is wrong with the tables of an export."""
    if len(tables) != len(due.ids):
        yield "", f"it holds {len(tables)} tables, but there are {len(due.ids)}"
        return
    for number, (name, table, wanted) in enumerate(zip(due.ids, tables, due.numbers, strict=True)):
        yield from ((name, each) for each in record_differences(number, table, wanted))
