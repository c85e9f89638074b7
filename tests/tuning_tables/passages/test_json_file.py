"""A table for point sensors survives its JSON file, and nothing that was changed on the way gets through."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

from tests.tuning_tables.passages.made_tables import passage_tables, table_of
from tests.tuning_tables.test_json_file import key_paths, parent_of, sealed
from tuning_tables import (
    ControllerTable,
    DamagedTable,
    NewerVersion,
    OlderVersion,
    OtherDecisions,
    TableError,
    UnknownFormat,
    from_json,
    from_table_json,
    passage_schema,
    read_table,
    to_json,
    to_table_json,
    write_table,
)
from tuning_tables.canonical import canonical_json
from tuning_tables.document import from_document
from tuning_tables.passages.json_file import (
    from_passage_json,
    read_passage_json,
    to_passage_json,
    write_passage_json,
)
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.sensor_layout import DecidesOn

Document = dict[str, Any]
PLAIN = table_of()
EVERY = replace(table_of(DecidesOn.EVERY_AXLE), validated=None)


def document_of(table: PassageTable) -> Document:
    document: Document = json.loads(to_passage_json(table))
    return document


def same_bits(one: PassageTable, other: PassageTable) -> bool:
    names = ("switching_m_s", "path_m", "sensor_of", "heard_path_m", "heard_sensor", "heard_passage", "limits")
    return one == other and all(getattr(one, name).tobytes() == getattr(other, name).tobytes() for name in names)


@given(passage_tables())
@settings(derandomize=True, max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
def test_both_layouts_of_a_table_are_read(original: PassageTable) -> None:
    exported = to_passage_json(original)
    for content in (exported, canonical_json(json.loads(exported))):
        assert same_bits(from_passage_json(content), original)
    assert to_passage_json(from_passage_json(exported)) == exported
    assert list(VALIDATOR.iter_errors(json.loads(exported))) == []


def test_a_table_survives_the_file(tmp_path: Path) -> None:
    for table in (PLAIN, EVERY):
        write_passage_json(table, tmp_path / "table.json")
        assert same_bits(read_passage_json(tmp_path / "table.json"), table)


def test_keys_and_their_order_are_the_contract() -> None:
    assert list(document_of(PLAIN)) == [
        "format",
        "version",
        "decisions",
        "id",
        "created",
        "generator",
        "retarder",
        "cut",
        "target_speed_m_s",
        "stages",
        "sensors",
        "approach",
        "passages",
        "plausible",
        "valid",
        "predicted",
        "validated",
        "crc32",
    ]
    assert (document_of(PLAIN)["version"], document_of(PLAIN)["decisions"]) == (4, "at_sensor_passages")
    lines = to_passage_json(PLAIN).splitlines()
    assert sum(line.startswith(b'  {"sensor": ') for line in lines) == len(PLAIN.passages)
    assert document_of(PLAIN)["passages"][1]["switching_m_s"] == [[5.0, None], [4.5, 6.25], [None, 5.5]]


def test_a_table_of_any_version_is_read_and_written(table: ControllerTable, tmp_path: Path) -> None:
    for each in (table, PLAIN):
        write_table(each, tmp_path / "table.json")
        assert read_table(tmp_path / "table.json") == each
        assert to_table_json(each) == (tmp_path / "table.json").read_bytes()
    assert to_table_json(table) == to_json(table)


def test_who_needs_the_other_kind_is_told_so(table: ControllerTable) -> None:
    with pytest.raises(
        OtherDecisions, match=r"^t\.json: version is 4, .*no lines.* give a table of version 1 to 3 or 5\.$"
    ):
        from_json(to_passage_json(PLAIN), "t.json")
    with pytest.raises(OtherDecisions, match="version is 4"):
        from_document(document_of(PLAIN), "t.json")
    with pytest.raises(OtherDecisions, match=r"^t\.json: version is 1, .*lines.* give a table of version 4\.$"):
        from_passage_json(to_json(table), "t.json")


@pytest.mark.parametrize(
    ("change", "error"),
    [
        ({"format": "retarder-book"}, UnknownFormat),
        ({"version": 6}, NewerVersion),
        ({"version": 0}, OlderVersion),
        ({"version": True}, DamagedTable),
        ({"version": 4.5}, DamagedTable),
        ({"version": "4"}, DamagedTable),
        ({"version": 3}, DamagedTable),
        ({"decisions": "in_time"}, DamagedTable),
        ({"polynomial": {"variable": "s_m", "degree": 3}}, DamagedTable),
    ],
)
def test_formats_versions_and_decisions_have_their_own_errors(change: Document, error: type[TableError]) -> None:
    with pytest.raises(TableError) as caught:
        from_table_json(sealed({**document_of(PLAIN), **change}), source="t.json")
    assert type(caught.value) is error
    assert str(caught.value).startswith("t.json: ")


@pytest.mark.parametrize(
    ("place", "key", "value", "match"),
    [
        (("approach",), "interlock", "none", "approach.interlock"),
        (("sensors",), "decides_on", "last_axle", "sensors.decides_on"),
        (("stages", 1), "k", 2, r"stages\[1\]\.k"),
        (("passages", 1), "sensor", 2, r"passages\[1\]"),
        (("passages", 1, "switching_m_s", 1), 0, None, None),
        (("passages", 1, "switching_m_s", 1), 0, 6.25, "switching_m_s"),
        (("passages", 1, "switching_m_s", 1), 0, 4.4, "float32"),
        (("predicted",), "passes", 100, "passes"),
    ],
)
def test_content_that_makes_no_table_is_refused(
    place: tuple[str | int, ...], key: str | int, value: object, match: str | None
) -> None:
    document = document_of(PLAIN)
    parent: Any = document
    for step in place:
        parent = parent[step]
    parent[key] = value
    if match is None:
        assert from_passage_json(sealed(document)).passages[1].switching_m_s[1][0] == -np.inf
        return
    with pytest.raises(DamagedTable, match=match):
        from_passage_json(sealed(document))


def test_every_key_is_required_even_under_a_right_checksum() -> None:
    paths = list(key_paths(document_of(PLAIN)))
    assert len(paths) > 60
    for path in paths:
        if path[-1] in ("category_number", "p_stall"):
            continue
        document = document_of(PLAIN)
        del parent_of(document, path)[path[-1]]
        content = canonical_json(document) if path == ("crc32",) else sealed(document)
        with pytest.raises(UnknownFormat if path == ("format",) else DamagedTable, match=path[-1]):
            from_passage_json(content)


def test_no_key_is_allowed_that_is_not_known() -> None:
    for place in [
        (),
        ("cut",),
        ("sensors",),
        ("approach",),
        ("plausible",),
        ("passages", 1),
        ("stages", 0),
        ("valid",),
    ]:
        document = document_of(PLAIN)
        parent_of(document, (*place, "surplus"))["surplus"] = 1
        with pytest.raises(DamagedTable, match="unknown key 'surplus'"):
            from_passage_json(sealed(document))


@pytest.mark.parametrize("wrong", [None, True, "4", [], {}, [None], -1, 0.5], ids=repr)
def test_no_value_of_another_type_gets_through(wrong: object) -> None:
    refused = 0
    for path in key_paths(document_of(PLAIN)):
        document = document_of(PLAIN)
        parent_of(document, path)[path[-1]] = copy.deepcopy(wrong)
        content = canonical_json(document) if path == ("crc32",) else sealed(document)
        try:
            # Some numbers may be others: then they must have arrived as they are.
            assert document_of(from_passage_json(content)) == json.loads(content), path
        except TableError:
            refused += 1
    assert refused >= 45


def test_a_key_given_twice_and_a_zero_with_a_sign_are_refused() -> None:
    content = to_passage_json(PLAIN)
    with pytest.raises(DamagedTable, match="'axle' is given twice"):
        from_passage_json(content.replace(b'"axle": 0', b'"axle": 0, "axle": 0', 1))
    with pytest.raises(DamagedTable, match="without a sign"):
        from_passage_json(content.replace(b'"pressure_kpa": 0.0', b'"pressure_kpa": -0.0'))


VALIDATOR = jsonschema.Draft202012Validator(passage_schema())


def places(value: Any, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    """Every member of the document, as a path of keys and indices."""
    members = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    found = [path] if path else []
    for key, member in members:
        found += places(member, (*path, key))
    return found


@pytest.mark.parametrize("wrong", [None, True, "", [], {}, -1], ids=repr)
def test_what_the_schema_refuses_the_reader_refuses_too(wrong: object) -> None:
    refused = 0
    for path in places(document_of(PLAIN)):
        if path[0] in ("format", "version", "crc32"):
            continue
        changed = document_of(PLAIN)
        parent: Any = changed
        for step in path[:-1]:
            parent = parent[step]
        parent[path[-1]] = wrong
        if not VALIDATOR.is_valid(changed):
            refused += 1
            with pytest.raises(DamagedTable):
                from_passage_json(sealed(changed))
    assert refused >= 60


def test_the_schema_is_one() -> None:
    jsonschema.Draft202012Validator.check_schema(passage_schema())


def smallest() -> PassageTable:
    """Two stages, two sensors, one axle."""
    return table_of(places_m=(-0.5, 26.0), axles_m=(0.0,), rows=((3.0,), (2.5,)), pressures=(0.0, 1e-7))


def contents() -> list[bytes]:
    """The two texts of the smallest table."""
    exported = to_passage_json(smallest())
    return [exported, canonical_json(json.loads(exported))]


def replaced(content: bytes, values: Callable[[int], Iterable[int]]) -> Iterator[bytes]:
    """`content` with one byte replaced, at every position, by all `values` of the byte there but itself."""
    for at, byte in enumerate(content):
        yield from (content[:at] + bytes([value]) + content[at + 1 :] for value in values(byte) if value != byte)


@pytest.mark.slow
def test_no_replaced_byte_gets_through_whatever_the_value() -> None:
    """Of the exported text; of the canonical one the telling bytes are tried below."""
    content, _ = contents()
    assert from_passage_json(content) == smallest()
    assert [text for text in replaced(content, lambda byte: range(256)) if is_read(from_passage_json, text)] == []


@pytest.mark.parametrize("read", [from_passage_json, from_table_json])
@pytest.mark.parametrize("content", contents(), ids=["export", "canonical"])
def test_no_telling_byte_gets_through_at_any_place(content: bytes, read: Callable[[bytes], object]) -> None:
    assert read(content) == smallest()
    assert [text for text in replaced(content, lambda byte: (*b'059",-', byte ^ 1)) if is_read(read, text)] == []


@pytest.mark.parametrize("content", contents(), ids=["export", "canonical"])
def test_no_lost_doubled_inserted_or_transposed_byte_gets_through(content: bytes) -> None:
    tried = []
    for at in range(len(content)):
        before, first, second, after = content[:at], content[at : at + 1], content[at + 1 : at + 2], content[at + 2 :]
        tried += [before + second + after, before + second + first + after]
        tried += [before + bytes([value]) + content[at:] for value in (content[at], 32, 48)]
    assert [text for text in tried if text != content and is_read(from_passage_json, text)] == []


def is_read(read: Callable[[bytes], object], content: bytes) -> bool:
    try:
        read(content)
    except TableError:
        return False
    return True
