"""A table survives the way through a JSON file unchanged; no other layout and no change of a single byte gets
through.
"""

import json
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.effort import sized
from tests.tuning_tables.every_kind import (
    Document,
    document_of,
    sealed,
    smallest_aim,
    smallest_lines,
    smallest_measured,
    smallest_points,
    smallest_surfaces,
)
from tuning_tables import ControllerTable, DamagedTable, TableError, from_json, to_json
from tuning_tables.document import KINDS, AnyTable
from tuning_tables.json_text import canonical_json


@pytest.mark.parametrize(
    "laid_out",
    [
        lambda document, content: json.dumps(document).encode(),
        lambda document, content: json.dumps(document, indent=1, ensure_ascii=False).encode(),
        lambda document, content: json.dumps(document, sort_keys=True, separators=(",", ":")).encode(),
        lambda document, content: canonical_json(document) + b"\n",
        lambda document, content: content + b"\n",
        lambda document, content: content.replace(b"\n", b"\r\n"),
        lambda document, content: content.replace(b's": 4.0', b's": 4.00'),
        lambda document, content: content.replace(b's": 4.0', b's": 4'),
        lambda document, content: content.replace(b's": 4.0', b's": 4e0'),
        lambda document, content: content.replace(b"leer", b"\\u006ceer"),
        lambda document, content: content.replace(b'zones_m": [[0.0', b'zones_m": [[-0.0'),
        lambda document, content: canonical_json(document).replace(b'"k":0', b'"k":-0'),
    ],
)
def test_any_other_layout_of_the_same_content_is_refused(
    table: ControllerTable, laid_out: Callable[[Document, bytes], bytes]
) -> None:
    content = laid_out(document_of(table), to_json(table))
    assert json.loads(content) == document_of(table)
    with pytest.raises(DamagedTable, match=r"laid out otherwise|without a sign"):
        from_json(content)


def test_large_whole_numbers_keep_their_value_in_both_layouts(table: ControllerTable) -> None:
    # The canonical form writes them without a point, and beyond 2^53 they still are numbers, but no counts.
    large = replace(table, predicted=replace(table.predicted, switchings=3e20, rms_m_s=2.0**60))
    document = document_of(large)
    assert b'"switchings":300000000000000000000}' in sealed(document)
    assert from_json(to_json(large)) == from_json(sealed(document)) == large
    with pytest.raises(DamagedTable, match=r"validated\.passes"):
        from_json(sealed({**document, "validated": {**document["validated"], "passes": 3e20}}))


@pytest.mark.requirement("FILE-01")
def test_no_truncated_file_gets_through(table: ControllerTable, surface_table: ControllerTable) -> None:
    for content in (to_json(table), sealed(document_of(table)), to_json(surface_table)):
        for length in range(len(content)):
            with pytest.raises(DamagedTable):
                from_json(content[:length])


def test_a_version_with_a_point_is_refused(table: ControllerTable) -> None:
    for content in (to_json(table), json.dumps(document_of(table)).encode()):
        with pytest.raises(DamagedTable, match=r"version is 1\.0"):
            from_json(content.replace(b'"version": 1,', b'"version": 1.0,'))


@pytest.mark.requirement("FILE-03")
@pytest.mark.parametrize(
    ("token", "reason"),
    [
        (b"NaN", "NaN is no JSON number"),
        (b"Infinity", "Infinity is no JSON number"),
        (b"-Infinity", "-Infinity is no JSON number"),
        (b"1e999", "must be finite"),
        (b"-1e999", "must be finite"),
        (b"9007199254740993", "crc32"),
        (b"9" * 400, "must be finite"),
        (b"-" + b"9" * 5000, "must be finite"),
    ],
    ids=lambda value: str(value[:20]),
)
def test_numbers_that_are_none_are_refused(table: ControllerTable, token: bytes, reason: str) -> None:
    content = to_json(table)
    assert content.count(b'"mass_t": 22.0') == 1
    with pytest.raises(DamagedTable, match=reason):
        from_json(content.replace(b'"mass_t": 22.0', b'"mass_t": ' + token))


@pytest.mark.requirement("FILE-03")
def test_a_key_given_twice_is_refused_though_the_last_one_is_right(table: ControllerTable) -> None:
    content = to_json(table).replace(b'"mass_t": 22.0', b'"mass_t": 85.0, "mass_t": 22.0')
    with pytest.raises(DamagedTable, match="'mass_t' is given twice"):
        from_json(content)


def test_a_lone_surrogate_is_refused(table: ControllerTable) -> None:
    content = to_json(table).replace(b'"medium"', b'"\\ud800"')
    with pytest.raises(DamagedTable):
        from_json(content)


@given(content=st.binary(max_size=200) | st.text(alphabet='{}[]",:0123eE+-.truefalsn', max_size=80).map(str.encode))
@settings(derandomize=True)
def test_noise_is_refused_in_order(content: bytes) -> None:
    with pytest.raises(TableError):
        from_json(content)


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
