"""No change of a single byte of a JSON table goes unnoticed, at any position, in either of its two layouts."""

import json
from collections.abc import Callable, Iterable, Iterator

import pytest

from tests.effort import sized
from tests.tuning_tables.every_kind import (
    smallest_aim,
    smallest_lines,
    smallest_measured,
    smallest_points,
    smallest_surfaces,
)
from tuning_tables import TableError, from_json, to_json
from tuning_tables.canonical import canonical_json
from tuning_tables.table_kinds import KINDS, AnyTable

Layout = Callable[[AnyTable], bytes]

PLACES = sized(7, 1)
"""Of so many places in a text one is tried."""

TELLING_BYTES = b"\x00\t\n\r \"'+,-./0123456789:E[\\]_aefx{}\x7f\x80\xc3\xff"


def export_layout(table: AnyTable) -> bytes:
    return to_json(table)


def canonical_layout(table: AnyTable) -> bytes:
    return canonical_json(json.loads(to_json(table)))


SMALLEST = [
    (export_layout, smallest_lines),
    (canonical_layout, smallest_lines),
    (export_layout, smallest_surfaces),
    (export_layout, smallest_points),
    (canonical_layout, smallest_aim),
]


def survivors(content: bytes, changed_texts: Iterable[bytes]) -> tuple[int, list[bytes]]:
    """Those of `changed_texts` that are read although they are not `content`, and how many were tried."""
    tried, read = 0, []
    for changed in changed_texts:
        if changed == content:
            continue
        tried += 1
        try:
            from_json(changed, *KINDS.values())
        except TableError:
            continue
        read.append(changed)
    return tried, read


def replacements(content: bytes, values: Iterable[int]) -> Iterator[bytes]:
    for position in range(0, len(content), PLACES):
        before, after = content[:position], content[position + 1 :]
        for value in values:
            yield before + bytes([value]) + after


@pytest.mark.requirement("FILE-01")
@pytest.mark.parametrize(("layout", "made"), SMALLEST[:3])
def test_no_replaced_byte_gets_through_whatever_the_value(layout: Layout, made: Callable[[], AnyTable]) -> None:
    content = layout(made())
    assert to_json(from_json(content, type(made()))) == to_json(made())
    tried, read = survivors(content, replacements(content, range(256)))
    assert tried == 255 * len(range(0, len(content), PLACES))
    assert read == []


@pytest.mark.requirement("FILE-01")
@pytest.mark.parametrize(("layout", "made"), SMALLEST)
def test_no_inserted_byte_gets_through(layout: Layout, made: Callable[[], AnyTable]) -> None:
    content = layout(made())
    inserted = (
        content[:position] + bytes([value]) + content[position:]
        for position in range(0, len(content) + 1, PLACES)
        for value in TELLING_BYTES
    )
    tried, read = survivors(content, inserted)
    assert tried == len(TELLING_BYTES) * len(range(0, len(content) + 1, PLACES))
    assert read == []


def one_byte_off(content: bytes) -> Iterator[bytes]:
    """`content` with one byte lost, doubled, exchanged with the next, or with one bit flipped, at every place."""
    for at in range(0, len(content), PLACES):
        before, first, second, after = content[:at], content[at : at + 1], content[at + 1 : at + 2], content[at + 2 :]
        yield before + second + after
        yield before + first + first + second + after
        yield before + second + first + after
        yield from (before + bytes([content[at] ^ 1 << bit]) + second + after for bit in range(8))


@pytest.mark.requirement("FILE-01")
@pytest.mark.parametrize("layout", [export_layout, canonical_layout])
@pytest.mark.parametrize("made", [smallest_points, smallest_aim, smallest_measured])
def test_no_lost_doubled_transposed_or_flipped_byte_gets_through(layout: Layout, made: Callable[[], AnyTable]) -> None:
    content = layout(made())
    assert to_json(from_json(content, type(made()))) == to_json(made())
    tried, read = survivors(content, one_byte_off(content))
    assert tried > 10.5 * (len(content) // PLACES)
    assert read == []
