"""A table survives the way through a JSON file unchanged, and nothing that was changed on the way gets through."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tuning_tables.every_kind import Document, document_of, sealed
from tuning_tables import (
    ControllerTable,
    DamagedTable,
    TableError,
    UnknownFormat,
    from_json,
    read_json,
    to_json,
)
from tuning_tables.canonical import canonical_json
from tuning_tables.json_text import LARGEST_FILE_BYTES


def test_the_canonical_form_is_the_one_other_layout(table: ControllerTable, linear_table: ControllerTable) -> None:
    for original in (table, linear_table):
        document = document_of(original)
        assert sealed(document) != to_json(original)
        assert from_json(sealed(document)) == original


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


@pytest.mark.parametrize(
    ("content", "error"),
    [
        (b"", DamagedTable),
        (b"\x89HDF\r\n\x1a\n", DamagedTable),
        (b"\xff\xfe{\x00}\x00", DamagedTable),
        (b'\xef\xbb\xbf{"format": "retarder-table"}', DamagedTable),
        (b"s_m,v_m_s\n0,1\n", DamagedTable),
        (b"{}", UnknownFormat),
        (b"null", UnknownFormat),
        (b"[1, 2]", UnknownFormat),
        (b'{"format": "geojson"}', UnknownFormat),
        (b'{"format": ' + b"[" * 500 + b"]" * 500 + b"}", UnknownFormat),
        (b"[" * 100_000, DamagedTable),
        (b'{"a":' * 100_000, DamagedTable),
        (b'{"format": "retarder-table", "version": ' + b"9" * 5000 + b"}", DamagedTable),
        (b" " * (LARGEST_FILE_BYTES + 1), DamagedTable),
    ],
    ids=lambda value: repr(value)[:24],
)
def test_foreign_files_are_refused(content: bytes, error: type[TableError]) -> None:
    with pytest.raises(TableError) as caught:
        from_json(content)
    assert type(caught.value) is error


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


def test_a_document_nested_in_a_known_key_is_refused(table: ControllerTable) -> None:
    deep = "[" * 400 + "]" * 400
    document = {**document_of(table), "id": json.loads(deep)}
    with pytest.raises(DamagedTable):
        from_json(sealed(document))


def test_a_lone_surrogate_is_refused(table: ControllerTable) -> None:
    content = to_json(table).replace(b'"medium"', b'"\\ud800"')
    with pytest.raises(DamagedTable):
        from_json(content)


def test_a_file_that_is_too_long_is_refused_unread(table: ControllerTable, tmp_path: Path) -> None:
    path = tmp_path / "long.json"
    path.write_bytes(to_json(table) + b" " * LARGEST_FILE_BYTES)
    with pytest.raises(DamagedTable, match=r"long\.json"):
        read_json(path)


def test_an_absent_file_is_an_os_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        read_json(tmp_path / "absent.json")


@given(content=st.binary(max_size=200) | st.text(alphabet='{}[]",:0123eE+-.truefalsn', max_size=80).map(str.encode))
@settings(derandomize=True)
def test_noise_is_refused_in_order(content: bytes) -> None:
    with pytest.raises(TableError):
        from_json(content)
