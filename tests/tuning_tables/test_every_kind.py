"""A table of any kind survives its file, and each fault of each declared member is refused by name."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

from tests.effort import sized
from tests.tuning_tables.aim.made_tables import random_table
from tests.tuning_tables.every_kind import (
    SAMPLES,
    Document,
    JsonPath,
    altered,
    document_of,
    dotted,
    leaves_of,
    places,
    sealed,
    smallest_aim,
    smallest_lines,
    too_far,
    value_at,
)
from tests.tuning_tables.passages.made_tables import passage_tables, table_of
from tests.tuning_tables.random_tables import tables
from tuning_tables import (
    ControllerTable,
    DamagedTable,
    NewerVersion,
    OtherKind,
    PassageTable,
    TableError,
    UnknownFormat,
    from_json,
    read_json,
    read_table,
    table_schema,
    to_json,
    write_json,
)
from tuning_tables.aim import AimTable
from tuning_tables.declared.members import members_of
from tuning_tables.document import HEAD, KINDS, AnyTable, kind_of, to_document
from tuning_tables.json_text import canonical_json

WRONG: list[object] = [None, "", "4", -1, [], [None], 0.5, *sized([], [True, {}])]
VALIDATORS = {kind: jsonschema.Draft202012Validator(table_schema(kind)) for kind in KINDS}


@pytest.fixture(params=SAMPLES)
def sample(request: pytest.FixtureRequest) -> AnyTable:
    return SAMPLES[request.param]()


def read_back(content: bytes, table: AnyTable, source: str = "table") -> AnyTable:
    found: AnyTable = from_json(content, type(table), source=source)
    return found


def conforms(document: Document) -> bool:
    return bool(VALIDATORS[document["kind"]].is_valid(document))


def test_a_table_survives_both_layouts_and_the_file(sample: AnyTable, tmp_path: Path) -> None:
    exported = to_json(sample)
    write_json(sample, tmp_path / "table.json")
    assert (tmp_path / "table.json").read_bytes() == exported
    for read in (
        read_json(tmp_path / "table.json", type(sample)),
        read_table(tmp_path / "table.json"),
        read_back(sealed(document_of(sample)), sample),
    ):
        assert type(read) is type(sample)
        assert to_json(read) == exported
        same_held(read, sample)
    assert max(map(len, exported.decode().splitlines())) <= 120


def same_held(one: AnyTable, other: AnyTable) -> None:
    """What controllers hold of both has the same bits."""
    assert type(one) is type(other)
    names = ("switching_m_s", "path_m", "heard_path_m", "limits") if isinstance(one, PassageTable) else ("held",)
    for name in names:
        assert [np.asarray(each).tobytes() for each in getattr(one, name)] == [
            np.asarray(each).tobytes() for each in getattr(other, name)
        ]


@given(tables() | passage_tables())
@settings(derandomize=True, max_examples=sized(20, 80), deadline=None, suppress_health_check=list(HealthCheck))
def test_random_tables_are_read_as_they_were_and_conform(table: AnyTable) -> None:
    for content in (to_json(table), canonical_json(document_of(table))):
        assert read_back(content, table) == table
    assert conforms(document_of(table))


@pytest.mark.parametrize("measured", [False, True])
def test_random_aim_tables_are_read_as_they_were_and_conform(measured: bool) -> None:
    for seed in range(30):
        table = random_table(seed, measured)
        for content in (to_json(table), canonical_json(document_of(table))):
            same_held(read_back(content, table), table)
        assert to_json(read_back(to_json(table), table)) == to_json(table)
        assert conforms(document_of(table))


def test_keys_and_their_order_follow_from_the_declaration(sample: AnyTable) -> None:
    assert list(document_of(sample)) == [*HEAD, *members_of(type(sample)), "crc32"]
    for kind, validator in VALIDATORS.items():
        jsonschema.Draft202012Validator.check_schema(validator.schema)
        assert validator.is_valid(document_of(sample)) == (kind == kind_of(type(sample)))


@pytest.mark.requirement("FILE-03")
def test_every_key_is_required_and_no_other_is_known(sample: AnyTable) -> None:
    document = document_of(sample)
    objects: list[JsonPath] = [(), *(path for path in places(document) if isinstance(value_at(document, path), dict))]
    for path in objects:
        content = value_at(document, path)
        for key in content:
            rest = {name: value for name, value in content.items() if name != key}
            changed = altered(document, path, rest) if path else rest
            text = canonical_json(changed) if (*path, key) == ("crc32",) else sealed(changed)
            with pytest.raises(UnknownFormat if (*path, key) == ("format",) else DamagedTable, match=key):
                read_back(text, sample)
        surplus = {**content, "surplus": 1}
        changed = altered(document, path, surplus) if path else surplus
        assert not conforms(changed)
        with pytest.raises(DamagedTable, match="unknown key 'surplus'"):
            read_back(sealed(changed), sample)


@pytest.mark.requirement("FILE-03")
@pytest.mark.parametrize("wrong", WRONG, ids=repr)
def test_no_value_of_another_type_gets_through(sample: AnyTable, wrong: object) -> None:
    """What the reader takes, the schema takes too."""
    document = document_of(sample)
    refused = 0
    for path in places(document):
        changed = altered(document, path, wrong)
        content = canonical_json(changed) if path == ("crc32",) else sealed(changed)
        try:
            # Some numbers may be others, and some members may be null: then they must have arrived as they are.
            told = json.loads(content)
            assert to_document(read_back(content, sample), told["exported_by"]) == told, path
        except TableError:
            refused += 1
        else:
            assert conforms(json.loads(content)), path
    assert refused >= 20


@pytest.mark.requirement("FILE-03")
def test_each_declared_limit_is_kept_and_the_fault_is_named(sample: AnyTable) -> None:
    document, tried = document_of(sample), 0
    for path, leaf in leaves_of(type(sample)):
        try:
            value_at(document, path)
        except TypeError:  # a section that this table does not have
            continue
        for value in too_far(leaf):
            changed = altered(document, path, value)
            with pytest.raises(DamagedTable) as refusal:
                read_back(sealed(changed), sample, "t.json")
            message = str(refusal.value)
            assert message.startswith("t.json: ")
            assert re.search(rf"\b{path[-1]}\b", message), (dotted(path), message)
            assert len(message) < 600
            tried += 1
    assert tried >= 35


def test_a_zero_has_no_sign(sample: AnyTable) -> None:
    document, tried = document_of(sample), 0
    for path in places(document):
        if type(value_at(document, path)) is float:
            text = sealed(altered(document, path, 0.125)).replace(b"0.125", b"-0.0")
            tried += 1
            with pytest.raises(DamagedTable):
                read_back(text, sample)
            zero = altered(document, path, 0.0)
            signed = json.dumps({**zero, "crc32": json.loads(sealed(zero))["crc32"]})
            content = json.dumps(altered(json.loads(signed), path, -0.0)).encode()
            with pytest.raises(DamagedTable, match=re.escape(dotted(path)) + r" is -0\.0, but .* without a sign"):
                read_back(content, sample)
    assert tried >= 10


@pytest.mark.requirement("FILE-04")
@pytest.mark.parametrize(
    ("change", "error", "words"),
    [
        ({"format": "retarder-book"}, UnknownFormat, 'it must be "retarder-table"'),
        ({"format": None}, UnknownFormat, "format is None"),
        ({"version": 2}, NewerVersion, "this reader knows only 1; update"),
        ({"version": 10**12}, NewerVersion, "version is 1000000000000"),
        ({"version": 0}, DamagedTable, "the whole number 1"),
        ({"version": True}, DamagedTable, "the whole number 1"),
        ({"version": 1.5}, DamagedTable, "the whole number 1"),
        ({"version": "1"}, DamagedTable, "the whole number 1"),
        ({"kind": "line"}, DamagedTable, "kind is 'line'"),
        ({"kind": None}, DamagedTable, "kind is None"),
        ({"created": "2026"}, DamagedTable, "created is '2026'"),
    ],
)
def test_formats_versions_and_kinds_have_their_own_errors(
    sample: AnyTable, change: Document, error: type[TableError], words: str
) -> None:
    with pytest.raises(TableError, match=words) as caught:
        read_back(sealed({**document_of(sample), **change}), sample, "t.json")
    assert type(caught.value) is error
    assert str(caught.value).startswith("t.json: ")


def test_who_needs_another_kind_is_told_so(tmp_path: Path) -> None:
    lines, points, aim = smallest_lines(), table_of(), smallest_aim()
    with pytest.raises(OtherKind, match=r"^t\.json: its kind is passages \(.*\), but .* whose kind is lines\.$"):
        from_json(to_json(points), source="t.json")
    with pytest.raises(OtherKind, match=r"^t\.json: its kind is lines \(.*\), but .* whose kind is passages\.$"):
        from_json(to_json(lines), PassageTable, source="t.json")
    write_json(aim, tmp_path / "aim.json")
    with pytest.raises(OtherKind, match=r"its kind is aim .* whose kind is lines or passages"):
        read_json(tmp_path / "aim.json", ControllerTable, PassageTable)
    assert isinstance(read_table(tmp_path / "aim.json"), AimTable)


@pytest.mark.parametrize(
    ("make", "path", "value", "words"),
    [
        ("points", ("passages", 1, "sensor"), 2, r"passages\[1\]"),
        ("points", ("passages", 1, "switching_m_s", 1, 0), 6.25, "switching_m_s"),
        ("points", ("passages", 1, "switching_m_s", 1, 0), 4.4, "float32"),
        ("points", ("predicted", "passes"), 100, "passes"),
        ("points", ("pressure_kpa", 1), 0.0, r"pressure_kpa\[1\]"),
        ("lines", ("stages", 1, "k"), 0, r"stages\[1\]\.k"),
        ("lines", ("predicted", "passes"), 100, "without an estimator"),
        ("surfaces", ("decisions",), "at_rest", "at rest"),
        ("surfaces", ("stages", 1, "lower_slope_m_s_per_kpa"), None, "all lines a slope"),
        ("whole", ("approach", "length_m"), 0.25, "approach.length_m"),
        ("whole", ("estimator", "s_m", 0), -0.25, "estimator.s_m"),
        ("aim", ("axes", "cars"), [1.5, 2.5], r"axes.cars\[0\] is 1.5, but .* a whole number"),
        ("aim", ("axes", "resistance_n_per_kn"), [1.0], "resistance_n_per_kn must be null where"),
        ("aim", ("exit_speed_m_s", 0), [0.5], r"exit_speed_m_s\[1\] is .* of the shape of the entries beside it"),
        ("aim", ("exit_speed_m_s", 1), None, r"exit_speed_m_s\[1\] is None"),
        ("aim", ("exit_speed_m_s", 1, 0), "1", r"\[1\]\[0\] is '1', but .* a number"),
        ("aim", ("bounds_m_s",), [1.0], "an array of two numbers"),
    ],
)
def test_what_makes_no_table_is_refused_by_name(make: str, path: JsonPath, value: Any, words: str) -> None:
    table = SAMPLES[make]()
    with pytest.raises(DamagedTable, match=words):
        read_back(sealed(altered(document_of(table), path, value)), table)


def test_a_switching_speed_that_is_null_is_never_reached() -> None:
    table = table_of()
    assert document_of(table)["passages"][1]["switching_m_s"] == [[5.0, None], [4.5, 6.25], [None, 5.5]]
    lower = altered(document_of(table), ("passages", 1, "switching_m_s", 1, 0), None)
    assert from_json(sealed(lower), PassageTable).passages[1].switching_m_s[1][0] == -np.inf


def test_the_schema_knows_which_numbers_categories_have(table: ControllerTable) -> None:
    made = replace(table, cut=replace(table.cut, category="own", category_number=16))
    assert conforms(document_of(made))
    for number in (1, 15, 256):
        assert not conforms(altered(document_of(made), ("cut", "category_number"), number))
