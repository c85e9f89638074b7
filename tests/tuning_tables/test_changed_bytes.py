"""No change of a single byte of a JSON table goes unnoticed, at any position, in either of its two layouts."""

import json
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

import pytest

from tuning_tables import (
    ControllerTable,
    CutId,
    Decisions,
    Generator,
    Predicted,
    RetarderId,
    Stage,
    TableError,
    Validated,
    ValidRange,
    from_json,
    to_json,
)
from tuning_tables.canonical import canonical_json

Layout = Callable[[ControllerTable], bytes]

TELLING_BYTES = b"\x00\t\n\r \"'+,-./0123456789:E[\\]_aefx{}\x7f\x80\xc3\xff"


def export_layout(table: ControllerTable) -> bytes:
    return to_json(table)


def canonical_layout(table: ControllerTable) -> bytes:
    return canonical_json(json.loads(to_json(table)))


def smallest_table() -> ControllerTable:
    """Two stages with constant lines; numbers of every form that the two layouts write differently."""
    return ControllerTable(
        id="t",
        created="2026-01-01T00:00:00Z",
        generator=Generator("g", "1", "0" * 64),
        retarder=RetarderId("r", ((0.0, 1.0),), 1.0, 1e-7),
        cut=CutId("Л", 1e22, (0.0,)),
        target_speed_m_s=2.5,
        degree=0,
        stages=(Stage(0, 0.0, None, (4.0,)), Stage(1, 100.0, (2.0,), None)),
        valid=ValidRange((0.0, 1.0), (0.0, 9.0)),
        predicted=Predicted(0.00001, -0.5, 0.0, 123456789012345678.0),
        validated=Validated(1, 0.0, (0.0, 1e16)),
    )


def smallest_surfaces() -> ControllerTable:
    """The smallest table with slopes."""
    first, second = smallest_table().stages
    stages = (replace(first, upper_slope_m_s_per_kpa=-0.5), replace(second, lower_slope_m_s_per_kpa=-(2.0**-24)))
    return replace(smallest_table(), stages=stages, decisions=Decisions.AT_ANY_TIME)


SMALLEST = [(export_layout, smallest_table), (canonical_layout, smallest_table), (export_layout, smallest_surfaces)]


def survivors(content: bytes, changed_texts: Iterable[bytes]) -> tuple[int, list[bytes]]:
    """Those of `changed_texts` that are read although they are not `content`, and how many were tried."""
    tried, read = 0, []
    for changed in changed_texts:
        if changed == content:
            continue
        tried += 1
        try:
            from_json(changed)
        except TableError:
            continue
        read.append(changed)
    return tried, read


def replacements(content: bytes, values: Iterable[int]) -> Iterator[bytes]:
    for position in range(len(content)):
        before, after = content[:position], content[position + 1 :]
        for value in values:
            yield before + bytes([value]) + after


@pytest.mark.parametrize(("layout", "made"), SMALLEST)
def test_no_replaced_byte_gets_through_whatever_the_value(layout: Layout, made: Callable[[], ControllerTable]) -> None:
    content = layout(made())
    assert from_json(content) == made()
    tried, read = survivors(content, replacements(content, range(256)))
    assert tried == 255 * len(content)
    assert read == []


@pytest.mark.parametrize(("layout", "made"), SMALLEST)
def test_no_inserted_byte_gets_through(layout: Layout, made: Callable[[], ControllerTable]) -> None:
    content = layout(made())
    inserted = (
        content[:position] + bytes([value]) + content[position:]
        for position in range(len(content) + 1)
        for value in TELLING_BYTES
    )
    tried, read = survivors(content, inserted)
    assert tried == len(TELLING_BYTES) * (len(content) + 1)
    assert read == []


@pytest.mark.parametrize(
    ("layout", "name"), [(export_layout, "table"), (canonical_layout, "table"), (export_layout, "surface_table")]
)
def test_no_flipped_lost_doubled_or_transposed_byte_of_a_usual_table_gets_through(
    layout: Layout, name: str, request: pytest.FixtureRequest
) -> None:
    table: ControllerTable = request.getfixturevalue(name)
    content = layout(table)
    assert from_json(content) == table
    places = range(len(content))
    pairs = [(content[:at], content[at : at + 1], content[at + 1 : at + 2], content[at + 2 :]) for at in places]
    lost = [before + second + after for before, _, second, after in pairs]
    doubled = [before + first + first + second + after for before, first, second, after in pairs]
    transposed = [before + second + first + after for before, first, second, after in pairs]
    flipped = [content[:at] + bytes([content[at] ^ 1 << bit]) + content[at + 1 :] for at in places for bit in range(8)]
    tried, read = survivors(content, [*lost, *doubled, *transposed, *flipped])
    assert tried > 10.5 * len(content)
    assert read == []
